#pragma once

#include "../common/MemberScore.h"

#include <rabit/RabitManager.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench.idl.h"

namespace Rabit::Bench
{

// The message that each member of a fleet posts, and the name of its node.
inline constexpr const char *MemberMessage = "Member";
std::string MemberNode(std::size_t member);

// A member of a fleet: posts its own message at a fixed rate and is woken by those of all others.
class MemberManager final : public RabitManager
{
public:
    explicit MemberManager(const BenchOptions &options);
    void ExecuteUnitOfWork() override;

private:
    void PostIfDue();

    MemberScore _score;
    const std::int64_t _period;
    std::int64_t _due;
    std::shared_ptr<::Bench::Sample> _own = std::make_shared<::Bench::Sample>();
    std::vector<std::pair<std::size_t, std::shared_ptr<::Bench::Sample>>> _others;
};

}  // namespace Rabit::Bench
