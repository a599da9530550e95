// How bulletins reach all nodes, and what they end.
#include <gtest/gtest.h>

#include "envelope/SealedFleet.h"

namespace
{

using namespace SealedFleets;

class SealedEpochs : public testing::Test
{
protected:
    static Epoch EpochOf(const SealedFleet &fleet, std::size_t index)
    {
        return fleet.Nodes[index]->Keys->Epochs().Newest();
    }
    static bool AreIn(const SealedFleet &fleet, Epoch epoch, std::size_t first, std::size_t end)
    {
        for (std::size_t index = first; index < end; ++index)
        {
            if (EpochOf(fleet, index) != epoch)
            {
                return false;
            }
        }
        return true;
    }
};

TEST_F(SealedEpochs, ABulletinReachesAllNodesWithinTwoSeconds)
{
    const auto fleet = FleetOf(4);
    fleet->StartAll();
    fleet->Run(5s);
    fleet->Nodes[0]->Keys->Learn(fleet->BulletinOf(2, {1, 2, 3, 4}));
    EXPECT_LE(fleet->RunUntil([&] { return AreIn(*fleet, 2, 0, 4); }, 10s), 2s);
    EXPECT_EQ(fleet->Nodes[3]->Stored, 1u);
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 10s), 1s);
}

TEST_F(SealedEpochs, ANodeHearsOthersWhileItLearnsTheNewEpoch)
{
    const auto fleet = FleetOf(3, {.Beat = 100ms});
    fleet->StartAll();
    fleet->Run(5s);
    fleet->Nodes[0]->Keys->Learn(fleet->BulletinOf(2, {1, 2, 3}));
    for (int i = 0; i < 50; ++i)
    {
        fleet->Run(100ms);
        EXPECT_LE(fleet->Now - fleet->Nodes[1]->Heard[0], 1s);
        EXPECT_LE(fleet->Now - fleet->Nodes[0]->Heard[1], 300ms);
    }
}

TEST_F(SealedEpochs, ALargeBulletinComesInPartsWhereDatagramsAreLost)
{
    const auto fleet = FleetOf(2, {.Loss = 0.2});
    fleet->StartAll();
    fleet->Run(5s);
    std::vector<Serial> numbers{1, 2};
    std::vector<Serial> revoked;
    for (Serial number = 3; number <= 2'000; ++number)
    {
        revoked.push_back(number);
    }
    const Bytes second = fleet->BulletinOf(2, numbers, revoked);
    ASSERT_GT(second.size(), 7 * BlobPartSize);
    fleet->Nodes[0]->Keys->Learn(second);
    EXPECT_LE(fleet->RunUntil([&] { return AreIn(*fleet, 2, 0, 2); }, 60s), 10s);
}

TEST_F(SealedEpochs, ARevokedNodeStaysOutWithinTheOverlapAndAfterwards)
{
    const auto fleet = FleetOf(4);
    fleet->StartAll();
    fleet->Run(5s);
    ASSERT_TRUE(fleet->AreAllOpen());
    fleet->Nodes[0]->Keys->Learn(fleet->BulletinOf(2, {1, 2, 3}, {4}));
    ASSERT_LE(fleet->RunUntil([&] { return AreIn(*fleet, 2, 0, 3); }, 10s), 2s);
    const auto isOut = [&](Duration time)
    {
        fleet->Run(1s);
        const TimePoint since = fleet->Now;
        fleet->Run(time);
        for (std::size_t to = 0; to < 3; ++to)
        {
            EXPECT_LT(fleet->Nodes[to]->Heard[3], since);
            EXPECT_FALSE(fleet->IsOpen(to, 3));
            EXPECT_GE(fleet->Nodes[to]->Heard[(to + 1) % 3], since);
            EXPECT_FALSE(fleet->Nodes[to]->Core->PeerOf(fleet->PrefixOfNode(3)));
        }
    };
    isOut(30s);
    EXPECT_EQ(EpochOf(*fleet, 3), 1);
    const auto rows = fleet->Nodes[3]->Keys->Problems();
    ASSERT_FALSE(rows.empty());
    EXPECT_EQ(rows.back().Entry, "uav4");
    // It starts anew, and the overlap ends.
    fleet->StartNode(3);
    isOut(30s);
    fleet->Jump(11min);
    isOut(30s);
    fleet->StartNode(3);
    isOut(30s);
}

TEST_F(SealedEpochs, HalfOfTheFleetLearnsWhatItMissed)
{
    const auto fleet = FleetOf(6);
    fleet->StartAll();
    fleet->Run(5s);
    fleet->Hears = [](std::size_t from, std::size_t to) { return (from < 3) == (to < 3); };
    fleet->Nodes[0]->Keys->Learn(fleet->BulletinOf(2, {1, 2, 3, 4, 5, 6}));
    fleet->Run(5s);
    fleet->Nodes[1]->Keys->Learn(fleet->BulletinOf(3, {1, 2, 3, 4, 5, 6}));
    fleet->Run(10s);
    ASSERT_TRUE(AreIn(*fleet, 3, 0, 3));
    ASSERT_TRUE(AreIn(*fleet, 1, 3, 6));
    // Longer than epoch 1 is heard, but for bulletins. One of them starts anew as well.
    fleet->Jump(12min);
    fleet->StartNode(4);
    fleet->Hears = [](std::size_t, std::size_t) { return true; };
    EXPECT_LE(fleet->RunUntil([&] { return AreIn(*fleet, 3, 0, 6); }, 60s), 5s);
    EXPECT_LE(fleet->RunUntil([&] { return fleet->AreAllOpen(); }, 60s), 3s);
}

TEST_F(SealedEpochs, ALoneNodeWithTheNewBulletinBringsItToTheOthers)
{
    const auto fleet = FleetOf(3);
    fleet->StartAll();
    fleet->Run(5s);
    const Bytes first = fleet->BulletinOf(1, {1, 2, 3});
    const Bytes second = fleet->BulletinOf(2, {1, 2, 3});
    fleet->MakeMember(2, {first, second});
    fleet->StartNode(2);
    EXPECT_LE(fleet->RunUntil([&] { return AreIn(*fleet, 2, 0, 3); }, 60s), 5s);
}

TEST_F(SealedEpochs, ABulletinThatCannotBeStoredIsUsedAndToldOf)
{
    const auto fleet = FleetOf(2);
    fleet->StartAll();
    fleet->Run(5s);
    fleet->Nodes[1]->MayStore = false;
    fleet->Nodes[0]->Keys->Learn(fleet->BulletinOf(2, {1, 2}));
    fleet->Run(5s);
    EXPECT_EQ(EpochOf(*fleet, 1), 2);
    const auto rows = fleet->Nodes[1]->Keys->Problems();
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].Text,
              "the bulletin of epoch 2 could not be stored: after a restart this node has to hear it again");
}

TEST_F(SealedEpochs, ABulletinOfAnotherAuthorityChangesNothing)
{
    const auto fleet = FleetOf(2);
    auto bytes = fleet->BulletinOf(2, {1, 2});
    bytes.back() ^= 1;
    static_cast<void>(fleet->Nodes[0]->Keys->Learn(bytes));
    EXPECT_EQ(EpochOf(*fleet, 0), 1);
    EXPECT_EQ(fleet->Nodes[0]->Stored, 0u);
    EXPECT_TRUE(fleet->Nodes[0]->Keys->KnowsBulletin(Sha256(bytes)));
}

TEST_F(SealedEpochs, KeysThatDoNotBelongTogetherMakeNoMember)
{
    SealedFleet fleet;
    const Bytes first = fleet.BulletinOf(1, {1});
    EXPECT_THROW(fleet.Add("uav2", 2, {first}), std::runtime_error);  // the bulletin does not name it
    EXPECT_THROW(fleet.Add("uav1", 1, {}), std::runtime_error);
    EXPECT_NO_THROW(fleet.Add("uav1", 1, {first}));
    EXPECT_NE(Rabit::MakeFleetMember({}).Error, "");
    EXPECT_EQ(Rabit::MakeFleetMember({}).Member, nullptr);
}

}  // namespace
