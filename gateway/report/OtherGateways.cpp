#include "report/OtherGateways.h"

#include <algorithm>
#include <set>
#include <typeindex>
#include <vector>

namespace Rabit::OtherGateways
{
namespace
{

std::set<std::string> NodesOf(const Gateway::Fleet &fleet)
{
    std::set<std::string> names;
    for (const Gateway::NodeStatus &status : fleet.nodes)
    {
        names.insert(status.node);
    }
    return names;
}

}  // namespace

void AddSharedNodes(RabitWorkspace &workspace, const std::string &name, Gateway::Fleet &fleet)
{
    const std::vector<std::string> gateways = workspace.GetListOfQueueForwarders();
    if (gateways.size() < 2)
    {
        return;
    }
    const std::set<std::string> own = NodesOf(fleet);
    bool isOtherFirst = true;
    for (const std::string &other : gateways)
    {
        if (other == name)
        {
            isOtherFirst = false;
            continue;
        }
        const auto global = workspace.FindGlobalMessage(other + "/Fleet");
        if (!global || global->MsgTypeIndex() != std::type_index(typeid(Gateway::Fleet)))
        {
            continue;  // a forwarder that is no gateway
        }
        Gateway::Fleet theirs;
        workspace.ForceFetchMessage(other + "/Fleet", &theirs);
        for (const std::string &node : NodesOf(theirs))
        {
            if (own.count(node) == 0)
            {
                continue;
            }
            fleet.problems.push_back({"node " + node, node,
                                      "the gateway `" + other +
                                          "` knows a node of this name too; queue messages for it go "
                                          "through `" +
                                          (isOtherFirst ? other : name) + "`"});
        }
    }
}

}  // namespace Rabit::OtherGateways
