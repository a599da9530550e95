#include "recording/merge/ClockReport.h"

#include <gtest/gtest.h>

#include <string>

namespace Rabit::Merge
{
namespace
{

Mcap::Bytes BytesOf(const std::string &text)
{
    return {text.begin(), text.end()};
}

constexpr const char *Report =
    R"({"incarnation":"18446744073709551615","source_to_log_ns":"-5","peers":[)"
    R"({"node":"uav2","incarnation":"2","source_to_log_ns":"1000","uncertain_by_ns":250},)"
    R"({"node":"uav3","incarnation":"3","source_to_log_ns":"7","uncertain_by_ns":null}]})";

TEST(ClockReport, HoldsTheOwnClockAndThoseOfPeers)
{
    const auto report = ReadClockReport(BytesOf(Report));
    ASSERT_TRUE(report.has_value());
    EXPECT_EQ(report->Incarnation, 18446744073709551615U);
    EXPECT_EQ(report->SourceToLog, -5);
    ASSERT_EQ(report->Peers.size(), 2U);
    EXPECT_EQ(report->Peers[0].Node, "uav2");
    EXPECT_EQ(report->Peers[0].SourceToLog, 1000);
    EXPECT_EQ(report->Peers[0].UncertainBy, 250);
    EXPECT_FALSE(report->Peers[1].UncertainBy.has_value());
}

TEST(ClockReport, LeavesOutPeersThatMakeNoSense)
{
    const auto report = ReadClockReport(
        BytesOf(R"({"incarnation":"1","source_to_log_ns":"0","peers":[4,{"node":5},{},)"
                R"({"node":"a","incarnation":"-1","source_to_log_ns":"0"},)"
                R"({"node":"a","incarnation":"1","source_to_log_ns":"9223372036854775807"},)"
                R"({"node":"b","incarnation":"1","source_to_log_ns":"3","uncertain_by_ns":-4}]})"));
    ASSERT_EQ(report->Peers.size(), 1U);
    EXPECT_EQ(report->Peers[0].Node, "b");
    EXPECT_FALSE(report->Peers[0].UncertainBy.has_value());
}

TEST(ClockReport, IsNoneOfOtherBytes)
{
    for (const char *text : {"", "{", "[]", "null", "{}", R"({"incarnation":1,"source_to_log_ns":"0"})",
                             R"({"incarnation":"1x","source_to_log_ns":"0"})"})
    {
        EXPECT_FALSE(ReadClockReport(BytesOf(text)).has_value()) << text;
    }
}

TEST(ClockReport, IsShiftedWithTheTimesOfItsFile)
{
    const auto shifted = ShiftClockReport(BytesOf(Report), 100);
    const auto report = ReadClockReport(*shifted);
    EXPECT_EQ(report->SourceToLog, 95);
    EXPECT_EQ(report->Peers[0].SourceToLog, 1100);
    EXPECT_EQ(report->Peers[0].UncertainBy, 250);
    EXPECT_FALSE(ShiftClockReport(BytesOf("nothing"), 100).has_value());
}

}  // namespace
}  // namespace Rabit::Merge
