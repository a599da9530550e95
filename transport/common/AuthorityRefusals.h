// Announcements that were refused because the certificate of their sender does not allow them.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "common/Rtps.h"

namespace Rabit::Rtps
{

// Remembers refused announcements as long as they stand, so that a person can be told of those that last. The
// announcement of an endpoint stands until the endpoint or its participant is gone. A participant that is
// refused as a whole goes without a word, so its announcement stands as long as it is repeated. Bounded.
// Thread-safe; calls nothing.
class AuthorityRefusals
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // If there are more, the one that was repeated last the longest time ago is forgotten.
    static constexpr std::size_t Most = 64;
    // A refusal lasts once it has stood for this long.
    static constexpr std::chrono::seconds Lasting{10};
    // Announcements of participants are repeated more often than this: the longest lease that is accepted.
    static constexpr std::chrono::seconds Repeated{300};

    // A refusal, for a person.
    struct Row
    {
        std::string Node;  // the name in the certificate
        std::string Text;
    };

    // `subject`: the endpoint that was announced, or ParticipantEntity.
    void Refused(const GuidPrefix &peer, EntityId subject, Row row, TimePoint now);
    // The subject is allowed now, or is gone.
    void Gone(const GuidPrefix &peer, EntityId subject);
    // The participant is gone, with all its endpoints.
    void Left(const GuidPrefix &peer);

    std::vector<Row> LastingRefusals(TimePoint now) const;

private:
    struct Refusal
    {
        Row What;
        TimePoint Began{};
        TimePoint Last{};
    };

    mutable std::mutex _mutex;
    std::map<std::pair<GuidPrefix, EntityId>, Refusal> _refusals;
};

}  // namespace Rabit::Rtps
