#include "agreement/TableExchange.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "SimRandom.h"
#include "agreement/TableCopy.h"
#include "agreement/TableMessages.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAreArray;

class TableExchanges : public ::testing::Test
{
protected:
    using Datagrams = std::vector<TableExchange::Datagram>;

    Datagrams TakeAll()
    {
        Datagrams datagrams;
        while (auto datagram = _exchange.TakeDatagram([](const auto &) { return true; }))
        {
            datagrams.push_back(std::move(*datagram));
        }
        return datagrams;
    }
    void Fill(std::size_t keys)
    {
        for (std::size_t i = 0; i < keys; ++i)
        {
            ASSERT_EQ(_table.Raise("key " + std::to_string(i), 1), TableCopy::Answer::Done);
        }
    }
    // A summary of keys that this node does not have.
    static TableSummary SummaryOf(std::uint64_t keys)
    {
        TableSummary summary;
        for (std::uint64_t key = 1; key <= keys; ++key)
        {
            summary.Pairs[key] = 1;
        }
        return summary;
    }

    TableCopy _table{"ground", 1};
    TableExchange _exchange{_table};
};

TEST_F(TableExchanges, SendNothingToANodeWithTheSameTable)
{
    Fill(1);
    _exchange.OnDigest("uav1", _table.Digest(), 0s);
    EXPECT_THAT(TakeAll(), IsEmpty());
}

TEST_F(TableExchanges, SendTheirSummaryToANodeWithAnotherTable)
{
    Fill(256);
    _exchange.OnDigest("uav1", 7, 0s);
    const Datagrams datagrams = TakeAll();
    ASSERT_EQ(datagrams.size(), 4U);
    EXPECT_EQ(datagrams.front().To, "uav1");
    EXPECT_TRUE(DecodeTableSummary(datagrams.front().Bytes));
}

TEST_F(TableExchanges, AskANodeThatDoesNotAnswerMoreAndMoreRarely)
{
    std::vector<std::chrono::nanoseconds> asked;
    for (std::chrono::nanoseconds now = 0s; now <= 100s; now += 250ms)
    {
        _exchange.OnDigest("uav1", 7, now);
        if (!TakeAll().empty())
        {
            asked.push_back(now);
        }
    }
    ASSERT_GE(asked.size(), 4U);
    EXPECT_EQ(asked[1] - asked[0], 250ms);
    EXPECT_EQ(asked[asked.size() - 1] - asked[asked.size() - 2], 16s);
}

TEST_F(TableExchanges, AskAtOnceIfTheOtherTableHasChanged)
{
    for (std::chrono::nanoseconds now = 0s; now <= 100s; now += 250ms)
    {
        _exchange.OnDigest("uav1", 7, now);
    }
    TakeAll();
    _exchange.OnDigest("uav1", 8, 100250ms);
    EXPECT_EQ(TakeAll().size(), 1U);
}

TEST_F(TableExchanges, AskAtOnceIfTheOwnTableHasChanged)
{
    for (std::chrono::nanoseconds now = 0s; now <= 100s; now += 250ms)
    {
        _exchange.OnDigest("uav1", 7, now);
    }
    TakeAll();
    Fill(1);
    _exchange.OnDigest("uav1", 7, 100250ms);
    EXPECT_EQ(TakeAll().size(), 1U);
}

TEST_F(TableExchanges, AskAtOnceIfTheOtherNodeWasForgotten)
{
    for (std::chrono::nanoseconds now = 0s; now <= 100s; now += 250ms)
    {
        _exchange.OnDigest("uav1", 7, now);
    }
    TakeAll();
    _exchange.Forget("uav1");
    _exchange.OnDigest("uav1", 7, 100250ms);
    EXPECT_EQ(TakeAll().size(), 1U);
}

TEST_F(TableExchanges, AskFourTimesASecondAtMostHoweverOftenATableChanges)
{
    std::uint64_t digest = 1;
    std::size_t asked = 0;
    for (std::chrono::nanoseconds now = 0s; now < 1s; now += 10ms)
    {
        _exchange.OnDigest("uav1", ++digest, now);
        asked += TakeAll().size();
    }
    EXPECT_EQ(asked, 4U);
}

TEST_F(TableExchanges, AnswerASummaryWithAllThatItsSenderDoesNotHave)
{
    Fill(2);
    TableSummary summary;
    summary.Room = 256;
    _exchange.OnDatagram("uav1", EncodeTableSummary(summary), 0s);
    const Datagrams datagrams = TakeAll();
    ASSERT_EQ(datagrams.size(), 1U);
    const auto entries = DecodeTableEntries(datagrams.front().Bytes);
    ASSERT_TRUE(entries);
    EXPECT_THAT(*entries, UnorderedElementsAreArray(_table.Entries()));
}

TEST_F(TableExchanges, SendNoNewKeysToANodeWithoutRoom)
{
    Fill(2);
    _exchange.OnDatagram("uav1", EncodeTableSummary({}), 0s);
    EXPECT_THAT(TakeAll(), IsEmpty());
}

TEST_F(TableExchanges, DoNotAnswerACopyOfASummaryFor200Milliseconds)
{
    const auto summary = EncodeTableSummary(SummaryOf(1));
    _exchange.OnDatagram("uav1", summary, 0s);
    EXPECT_EQ(TakeAll().size(), 1U);
    _exchange.OnDatagram("uav1", summary, 199ms);
    EXPECT_EQ(TakeAll().size(), 0U);
    EXPECT_EQ(_exchange.Unanswered(), 1U);
    _exchange.OnDatagram("uav1", summary, 200ms);
    EXPECT_EQ(TakeAll().size(), 1U);
}

TEST_F(TableExchanges, RequestKeysThatTheyDoNotHaveSixteenAtATime)
{
    _exchange.OnDatagram("uav1", EncodeTableSummary(SummaryOf(64)), 0s);
    const Datagrams datagrams = TakeAll();
    ASSERT_EQ(datagrams.size(), 4U);
    const auto request = DecodeTableRequest(datagrams.front().Bytes);
    ASSERT_TRUE(request);
    EXPECT_EQ(request->Keys.size(), 16U);
}

TEST_F(TableExchanges, RequestNoMoreKeysThanTheTableHasRoomForAndCountTheOthers)
{
    Fill(250);
    TableSummary summary = SummaryOf(64);
    summary.Last = 64;
    _exchange.OnDatagram("uav1", EncodeTableSummary(summary), 0s);
    const Datagrams datagrams = TakeAll();
    ASSERT_EQ(datagrams.size(), 1U);
    const auto request = DecodeTableRequest(datagrams.front().Bytes);
    ASSERT_TRUE(request);
    EXPECT_EQ(request->Keys.size(), 6U);
    EXPECT_EQ(_table.Refused(), 58U);
}

TEST_F(TableExchanges, SendTheEntriesThatAreRequested)
{
    Fill(2);
    const auto &[key, entries] = *_table.Summary().begin();
    _exchange.OnDatagram("uav1", EncodeTableRequest({.Keys = {key, key + 1}}), 0s);
    const Datagrams datagrams = TakeAll();
    ASSERT_EQ(datagrams.size(), 1U);
    EXPECT_EQ(DecodeTableEntries(datagrams.front().Bytes), _table.EntriesOf(key));
}

TEST_F(TableExchanges, SendAWholeTableToOnePeerIn200MillisecondsAtMostHoweverOftenItRequests)
{
    Fill(1);
    const auto request = EncodeTableRequest(
        {.Keys = std::vector<std::uint64_t>(TableRequest::MostKeys, _table.Summary().begin()->first)});
    std::size_t answers = 0;
    for (int i = 0; i < 50; ++i)
    {
        _exchange.OnDatagram("uav1", request, 199ms);
        answers += TakeAll().empty() ? 0U : 1U;
    }
    EXPECT_EQ(answers, TableCopy::MostKeys / TableRequest::MostKeys);
    _exchange.OnDatagram("uav2", request, 199ms);
    EXPECT_FALSE(TakeAll().empty()) << "another peer";
    _exchange.OnDatagram("uav1", request, 399ms);
    EXPECT_FALSE(TakeAll().empty());
}

TEST_F(TableExchanges, GiveTheFirstDatagramThatMayGo)
{
    Fill(1);
    _exchange.OnDigest("uav1", 7, 0s);
    _exchange.OnDigest("uav2", 7, 0s);
    EXPECT_FALSE(_exchange.TakeDatagram([](const auto &) { return false; }));
    const auto datagram = _exchange.TakeDatagram([](const auto &waiting) { return waiting.To == "uav2"; });
    ASSERT_TRUE(datagram);
    EXPECT_EQ(datagram->To, "uav2");
    EXPECT_EQ(TakeAll().size(), 1U);
    EXPECT_FALSE(_exchange.IsWaiting());
}

TEST_F(TableExchanges, SendBackWhatIsNewerThanAnEntryThatCame)
{
    Fill(1);
    TableCopy older("uav1", 1);
    older.Raise("key 0", -5);
    _exchange.OnDatagram("uav1", EncodeTableEntries(older.Entries()).front(), 0s);
    const Datagrams datagrams = TakeAll();
    ASSERT_EQ(datagrams.size(), 1U);
    EXPECT_EQ(DecodeTableEntries(datagrams.front().Bytes), _table.Entries());
}

TEST_F(TableExchanges, SendNothingBackForAnEntryThatIsNew)
{
    TableCopy other("uav1", 1);
    other.Write("key", "value");
    _exchange.OnDatagram("uav1", EncodeTableEntries(other.Entries()).front(), 0s);
    EXPECT_THAT(TakeAll(), IsEmpty());
    EXPECT_EQ(_table.Entries(), other.Entries());
}

TEST_F(TableExchanges, DropDatagramsBeyond64ThatWait)
{
    Fill(256);
    for (int i = 0; i < 20; ++i)
    {
        _exchange.OnDigest("uav" + std::to_string(i), 7, 0s);
    }
    EXPECT_EQ(TakeAll().size(), 64U);
    EXPECT_EQ(_exchange.Dropped(), 16U);
}

TEST_F(TableExchanges, ForgetThePeerThatWasHeardLongestAgoIfThereAreMoreThan1024)
{
    for (int i = 0; i < 1025; ++i)
    {
        _exchange.OnDigest("uav" + std::to_string(i), 7, std::chrono::microseconds(i));
    }
    EXPECT_EQ(_exchange.Peers(), 1024U);
    TakeAll();
    // The second one is still known, and was asked just now.
    _exchange.OnDigest("uav1", 7, 2ms);
    EXPECT_THAT(TakeAll(), IsEmpty());
    _exchange.OnDigest("uav0", 7, 2ms);
    EXPECT_EQ(TakeAll().size(), 1U);
}

TEST_F(TableExchanges, CountBytesThatAreNoDatagram)
{
    _exchange.OnDatagram("uav1", {}, 0s);
    _exchange.OnDatagram("uav1", std::vector<std::uint8_t>{1, 2, 3}, 0s);
    EXPECT_EQ(_exchange.Malformed(), 2U);
}

// Datagrams with changed, missing and added bytes. The table keeps its bounds, and still merges with another
// one.
TEST_F(TableExchanges, StayWithinTheirBoundsUnderAnyBytes)
{
    Sim::SimRandom random(1);
    Fill(20);
    _table.Write("written", "value");
    _table.Add("numbers", 9);
    std::vector<std::vector<std::uint8_t>> good = EncodeTableEntries(_table.Entries());
    good.push_back(EncodeTableSummary(TableSummariesOf(_table.Summary(), _table.Room()).front()));
    good.push_back(EncodeTableRequest({.Keys = {_table.Summary().begin()->first, 2, 3}}));
    for (int i = 0; i < 20000; ++i)
    {
        std::vector<std::uint8_t> bytes = good[random.Index(good.size())];
        for (std::size_t changes = random.Index(4); changes > 0; --changes)
        {
            bytes[random.Index(bytes.size())] = static_cast<std::uint8_t>(random.Next());
        }
        bytes.resize(random.Chance(0.2) ? random.Index(bytes.size() + 10) : bytes.size());
        _exchange.OnDatagram("uav1", bytes, std::chrono::milliseconds(i));
        ASSERT_LE(TakeAll().size(), TableExchange::MostWaiting);
    }
    EXPECT_LE(_table.Entries().size(), TableCopy::MostKeys);
    EXPECT_GT(_exchange.Malformed(), 0U);
    for (const TableEntry &entry : _table.Entries())
    {
        EXPECT_TRUE(HasGoodKey(entry) && HasGoodValue(entry));
    }
    TableCopy other("uav1", 1);
    for (const auto &datagram : EncodeTableEntries(_table.Entries()))
    {
        const auto entries = DecodeTableEntries(datagram);
        ASSERT_TRUE(entries);
        std::for_each(entries->begin(), entries->end(), [&](const TableEntry &entry) { other.Meet(entry); });
    }
    EXPECT_EQ(other.Digest(), _table.Digest());
}

}  // namespace
}  // namespace Rabit
