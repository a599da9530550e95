#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace Rabit
{
class PublishSubscribeMessage;
class RabitMessage;
class RabitWorkspace;

// Registers a message under a name for as long as the lease lives: for names that come and go while the
// program runs. The name leaves the workspace with the lease, unless it was also registered otherwise. A
// global copy that is still shared remains usable. The next registration of the name makes another one.
//
// Thread-safe. The workspace must outlive the lease.
class RabitMessageLease
{
public:
    // Registers as RabitWorkspace::RegisterMessage does.
    RabitMessageLease(RabitWorkspace &workspace, std::string name,
                      const std::shared_ptr<RabitMessage> &message);
    ~RabitMessageLease();
    RabitMessageLease(const RabitMessageLease &) = delete;
    RabitMessageLease &operator=(const RabitMessageLease &) = delete;

    // The global copy of the name. Null if the name belongs to a message of another type: then the message is
    // not registered.
    const std::shared_ptr<PublishSubscribeMessage> &Global() const { return _global; }

private:
    RabitWorkspace &_workspace;
    const std::string _name;
    const std::uint64_t _owner;
    std::shared_ptr<PublishSubscribeMessage> _global;
};

}  // namespace Rabit
