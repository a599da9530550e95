#pragma once

#include <rabit/PublishSubscribeClass.h>
#include <rabit/RabitWorkspace.h>

#include <memory>
#include <string>
#include <unordered_map>

namespace Rabit::Rerun
{

// The names of the messages of a workspace. Used by one thread.
class MessageNames
{
public:
    explicit MessageNames(const RabitWorkspace &workspace) : _workspace(workspace) {}

    // Returns the name of a message; empty if it has none any more.
    const std::string &Of(const PublishSubscribeMessage &global)
    {
        const auto known = _known.find(&global);
        return known != _known.end() ? known->second.Name : Find(global);
    }

private:
    struct Known
    {
        std::shared_ptr<PublishSubscribeMessage> Global;  // so that its address stays its own
        std::string Name;
    };

    const std::string &Find(const PublishSubscribeMessage &global)
    {
        for (const MessageInfo &message : _workspace.GetListOfMessages())
        {
            if (auto found = _workspace.FindGlobalMessage(message.Name); found.get() == &global)
            {
                return _known.emplace(&global, Known{std::move(found), message.Name}).first->second.Name;
            }
        }
        static const std::string none;
        return none;
    }

    const RabitWorkspace &_workspace;
    std::unordered_map<const PublishSubscribeMessage *, Known> _known;
};

}  // namespace Rabit::Rerun
