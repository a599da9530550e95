#include "TestManagers.h"
#include "TestMessages.h"

#include <rabit/RabitMessageLease.h>
#include <rabit/RabitWorkspace.h>

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <thread>

namespace
{

using namespace Rabit;
using namespace RabitTest;

TEST(RabitMessageLease, TheNameGoesWithTheLease)
{
    RabitWorkspace workspace;
    {
        const RabitMessageLease lease(workspace, "Name", std::make_shared<NumberMessage>());
        EXPECT_EQ(workspace.FindGlobalMessage("Name"), lease.Global());
        EXPECT_NE(lease.Global(), nullptr);
    }
    EXPECT_EQ(workspace.FindGlobalMessage("Name"), nullptr);
    EXPECT_TRUE(workspace.GetListOfMessages().empty());
}

TEST(RabitMessageLease, TheNameStaysIfSomebodyRegisteredItBesides)
{
    RabitWorkspace workspace;
    const auto mine = std::make_shared<NumberMessage>();
    std::shared_ptr<PublishSubscribeMessage> global;
    {
        const RabitMessageLease lease(workspace, "Name", std::make_shared<NumberMessage>());
        workspace.AddPublishSubscribeMessage("Name", mine);
        global = lease.Global();
    }
    EXPECT_EQ(workspace.FindGlobalMessage("Name"), global);
}

TEST(RabitMessageLease, TheNameStaysIfAManagerRegisteredItBefore)
{
    RabitWorkspace workspace;
    ScriptedManager manager("Manager", workspace);
    manager.AddPublishSubscribeMessage("Name", std::make_shared<NumberMessage>());
    const auto global = workspace.FindGlobalMessage("Name");
    {
        const RabitMessageLease lease(workspace, "Name", std::make_shared<NumberMessage>());
        EXPECT_EQ(lease.Global(), global);
    }
    EXPECT_EQ(workspace.FindGlobalMessage("Name"), global);
}

TEST(RabitMessageLease, OfTwoLeasesTheSecondToEndTakesTheNameAway)
{
    RabitWorkspace workspace;
    std::optional<RabitMessageLease> first(std::in_place, workspace, "Name",
                                           std::make_shared<NumberMessage>());
    std::optional<RabitMessageLease> second(std::in_place, workspace, "Name",
                                            std::make_shared<NumberMessage>());
    first.reset();
    EXPECT_EQ(workspace.FindGlobalMessage("Name"), second->Global());
    second.reset();
    EXPECT_EQ(workspace.FindGlobalMessage("Name"), nullptr);
}

TEST(RabitMessageLease, ALeaseOfAnotherTypeHasNoGlobalCopyAndLeavesTheName)
{
    RabitWorkspace workspace;
    workspace.AddPublishSubscribeMessage("Name", std::make_shared<NumberMessage>());
    {
        const RabitMessageLease lease(workspace, "Name", std::make_shared<AssigningMessage>());
        EXPECT_EQ(lease.Global(), nullptr);
    }
    EXPECT_NE(workspace.FindGlobalMessage("Name"), nullptr);
}

TEST(RabitMessageLease, AnOlderLeaseDoesNotTakeAwayTheNameThatWasRegisteredAnew)
{
    RabitWorkspace workspace;
    std::optional<RabitMessageLease> older(std::in_place, workspace, "Name",
                                           std::make_shared<NumberMessage>());
    workspace.LeavingReactor();
    const RabitMessageLease newer(workspace, "Name", std::make_shared<NumberMessage>());
    older.reset();
    EXPECT_EQ(workspace.FindGlobalMessage("Name"), newer.Global());
}

TEST(RabitMessageLease, LeasesOfOneNameComeAndGoOnSeveralThreads)
{
    RabitWorkspace workspace;
    const auto comeAndGo = [&workspace]
    {
        for (int i = 0; i < 1000; ++i)
        {
            const RabitMessageLease lease(workspace, "Name", std::make_shared<NumberMessage>());
            EXPECT_NE(lease.Global(), nullptr);
            EXPECT_NE(workspace.FindGlobalMessage("Name"), nullptr);
        }
    };
    std::thread other(comeAndGo);
    comeAndGo();
    other.join();
    EXPECT_EQ(workspace.FindGlobalMessage("Name"), nullptr);
}

}  // namespace
