#include <rabit/RabitMessageLease.h>

#include "WorkspaceRegistry.h"

#include <rabit/RabitWorkspace.h>

#include <utility>

namespace Rabit
{

RabitMessageLease::RabitMessageLease(RabitWorkspace &workspace, std::string name,
                                     const std::shared_ptr<RabitMessage> &message)
    : _workspace(workspace), _name(std::move(name)), _owner(workspace._registry->NewOwner())
{
    MessageRegistration registration = _workspace.RegisterMessageFor(_name, message, _owner, nullptr);
    if (registration.Result != MessageRegistrationResult::OtherType)
    {
        _global = std::move(registration.Global);
    }
}

RabitMessageLease::~RabitMessageLease()
{
    _workspace._registry->ReleaseMessage(_name, _owner);
}

}  // namespace Rabit
