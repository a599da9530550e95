#include <rabit/ManagerControlMessage.h>
#include <rabit/ManagerStats.h>
#include <rabit/ManagerStatusMessage.h>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace
{

using namespace Rabit;

TEST(ManagerControlMessage, HasItsDefaultsAndClearRestoresThem)
{
    ManagerControlMessage message;
    for (int round = 0; round < 2; ++round)
    {
        EXPECT_EQ(message.ManagerName, "Unknown");
        EXPECT_FALSE(message.ResetMgrStatsToggle);
        EXPECT_EQ(message.PublishMgrStatsTime_Sec, 10.0);
        EXPECT_FALSE(message.GetShutdownManager());
        message.ManagerName = "Another";
        message.ResetMgrStatsToggle = true;
        message.PublishMgrStatsTime_Sec = 1.0;
        message.ShutdownManager(true);
        message.Clear();
    }
}

ManagerControlMessage SomeControl()
{
    ManagerControlMessage message;
    message.MessageType = 7;
    message.SetTimeStamp(99.5);
    message.ManagerName = "Pilot";
    message.ResetMgrStatsToggle = true;
    message.PublishMgrStatsTime_Sec = 2.5;
    message.ShutdownManager(true);
    return message;
}

TEST(ManagerControlMessage, IsCopiedAndCloned)
{
    ManagerControlMessage from = SomeControl();
    ManagerControlMessage to;
    EXPECT_TRUE(to.CopyMessage(&from));
    EXPECT_EQ(to.ToString(), from.ToString());
    EXPECT_EQ(to.GetTimeStamp(), 99.5);
    EXPECT_EQ(from.Clone()->ToString(), from.ToString());
    ManagerStatusMessage other;
    EXPECT_FALSE(to.CopyMessage(&other));
}

TEST(ManagerControlMessage, IsSerializedBigEndian)
{
    ManagerControlMessage from = SomeControl();
    std::array<std::uint8_t, 64> buffer{};
    ASSERT_EQ(from.Serialize(buffer.data(), 64), 20 + 2 + 5 + 1 + 1 + 8);
    EXPECT_EQ(buffer[3], 7);
    EXPECT_EQ(buffer[21], 5);
    EXPECT_EQ(buffer[22], 'P');
    EXPECT_EQ(buffer[27], 1);
    EXPECT_EQ(buffer[28], 1);
    ManagerControlMessage to;
    EXPECT_EQ(to.DeSerialize(buffer.data(), 64), 37);
    EXPECT_EQ(to.ToString(), from.ToString());
    EXPECT_EQ(to.MessageType, 7);
}

TEST(ManagerControlMessage, IsNotReadFromFewerBytesThanItHasNorWrittenToThem)
{
    ManagerControlMessage from = SomeControl();
    std::array<std::uint8_t, 64> buffer{};
    from.Serialize(buffer.data(), 64);
    for (int size = 0; size < 37; ++size)
    {
        ManagerControlMessage to;
        EXPECT_EQ(to.DeSerialize(buffer.data(), size), 0) << size;
        EXPECT_EQ(to.ManagerName, "Unknown");
        std::array<std::uint8_t, 64> target{};
        EXPECT_EQ(from.Serialize(target.data(), size), 0) << size;
    }
}

ManagerStatusMessage SomeStatus()
{
    ManagerStatusMessage message;
    message.SetTimeStamp(99.5);
    message.ManagerName = "Pilot";
    message.RunningState = ManagerStatusMessage::MgrState_Running;
    message.ErrorCondition = true;
    message.ErrorCode = -3;
    message.ManagerStats.TotalNumberOfExecuteCycles = 1;
    message.ManagerStats.NumberOfExecuteCycles = 2;
    message.ManagerStats.MinSleepTime_Sec = 0.25;
    message.ManagerStats.NumberOfWakeUpCallsWhileAwake = 4;
    return message;
}

TEST(ManagerStatusMessage, ClearKeepsNameAndState)
{
    ManagerStatusMessage message = SomeStatus();
    message.Clear();
    EXPECT_EQ(message.ManagerName, "Pilot");
    EXPECT_EQ(message.RunningState, ManagerStatusMessage::MgrState_Running);
    EXPECT_FALSE(message.ErrorCondition);
    EXPECT_EQ(message.ErrorCode, 0);
    EXPECT_EQ(message.ManagerStats.NumberOfExecuteCycles, 0);
}

TEST(ManagerStatusMessage, IsCopiedAndCloned)
{
    ManagerStatusMessage from = SomeStatus();
    ManagerStatusMessage to;
    EXPECT_TRUE(to.CopyMessage(&from));
    EXPECT_EQ(to.ToString(), from.ToString());
    EXPECT_EQ(from.Clone()->ToString(), from.ToString());
    EXPECT_FALSE(to.CopyMessage(nullptr));
}

TEST(ManagerStatusMessage, IsSerializedBigEndian)
{
    ManagerStatusMessage from = SomeStatus();
    std::array<std::uint8_t, 256> buffer{};
    const int size = 20 + 2 + 5 + 1 + 1 + 4 + 4 * 4 + 9 * 8;
    ASSERT_EQ(from.Serialize(buffer.data(), 256), size);
    EXPECT_EQ(buffer[27], 1);                                  // state
    EXPECT_EQ(buffer[28], 1);                                  // error condition
    EXPECT_EQ(buffer[32], 0xFD);                               // the last byte of -3
    EXPECT_EQ(buffer[36], 1);                                  // total number of cycles
    EXPECT_EQ(buffer[40], 2);                                  // number of cycles
    EXPECT_EQ(buffer[static_cast<std::size_t>(size) - 1], 4);  // wake-ups while awake
    ManagerStatusMessage to;
    EXPECT_EQ(to.DeSerialize(buffer.data(), size), size);
    EXPECT_EQ(to.ToString(), from.ToString());
    for (int shorter = 0; shorter < size; ++shorter)
    {
        ManagerStatusMessage none;
        EXPECT_EQ(none.DeSerialize(buffer.data(), shorter), 0) << shorter;
        std::array<std::uint8_t, 256> target{};
        EXPECT_EQ(from.Serialize(target.data(), shorter), 0) << shorter;
    }
}

TEST(ManagerStatusMessage, WithAnImpossibleStateIsNotRead)
{
    ManagerStatusMessage from = SomeStatus();
    std::array<std::uint8_t, 256> buffer{};
    from.Serialize(buffer.data(), 256);
    buffer[27] = 3;
    ManagerStatusMessage to;
    EXPECT_EQ(to.DeSerialize(buffer.data(), 256), 0);
    EXPECT_EQ(to.ManagerName, "Unknown");
}

TEST(ManagerStats, KeepMinimumMaximumAverageAndTotal)
{
    ManagerStats_t stats;
    for (const double time : {2.0, 1.0, 6.0})
    {
        stats.UpdateExeUnitOfWorkTimeStats(time);
        stats.UpdateSleepTimeStats(10.0 * time);
    }
    EXPECT_EQ(stats.MinExecuteUnitOfWorkTime_Sec, 1.0);
    EXPECT_EQ(stats.MaxExecuteUnitOfWorkTime_Sec, 6.0);
    EXPECT_EQ(stats.AveExecuteUnitOfWorkTime_Sec, 3.0);
    EXPECT_EQ(stats.TotalExecuteUnitOfWorkTime_Sec, 9.0);
    EXPECT_EQ(stats.MinSleepTime_Sec, 10.0);
    EXPECT_EQ(stats.MaxSleepTime_Sec, 60.0);
    EXPECT_EQ(stats.AveSleepTime_Sec, 30.0);
    EXPECT_EQ(stats.TotalSleepTime_Sec, 90.0);
}

TEST(ManagerStats, ClearKeepsTheTotalNumberOfCycles)
{
    ManagerStats_t stats;
    stats.TotalNumberOfExecuteCycles = 5;
    stats.NumberOfExecuteCycles = 5;
    stats.UpdateExeUnitOfWorkTimeStats(1.0);
    stats.Clear();
    EXPECT_EQ(stats.TotalNumberOfExecuteCycles, 5);
    EXPECT_EQ(stats.NumberOfExecuteCycles, 0);
    stats.UpdateExeUnitOfWorkTimeStats(3.0);
    EXPECT_EQ(stats.MinExecuteUnitOfWorkTime_Sec, 3.0);
    EXPECT_FALSE(stats.ToString().empty());
}

}  // namespace
