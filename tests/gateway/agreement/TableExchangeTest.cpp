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
    ASSERT_EQ(datagrams.size(), 1U);
    EXPECT_EQ(datagrams.front().To, "uav1");
    EXPECT_LE(datagrams.front().Bytes.size(), 1200U);
    const auto summary = DecodeTableSummary(datagrams.front().Bytes);
    ASSERT_TRUE(summary);
    EXPECT_THAT(_table.EntriesBeside(summary->Hashes, summary->Salt), IsEmpty());
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
    _exchange.ForgetUnless([](const std::string &peer) { return peer != "uav1"; });
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
    _exchange.OnDatagram("uav1", EncodeTableSummary({}), 0s);
    const Datagrams datagrams = TakeAll();
    ASSERT_EQ(datagrams.size(), 1U);
    const auto entries = DecodeTableEntries(datagrams.front().Bytes);
    ASSERT_TRUE(entries);
    EXPECT_THAT(*entries, UnorderedElementsAreArray(_table.Entries()));
}

TEST_F(TableExchanges, DoNotAnswerACopyOfASummaryFor200Milliseconds)
{
    Fill(1);
    const auto summary = EncodeTableSummary({});
    _exchange.OnDatagram("uav1", summary, 0s);
    EXPECT_EQ(TakeAll().size(), 1U);
    _exchange.OnDatagram("uav1", summary, 199ms);
    EXPECT_EQ(TakeAll().size(), 0U);
    _exchange.OnDatagram("uav2", summary, 199ms);
    EXPECT_EQ(TakeAll().size(), 1U) << "another peer";
    _exchange.OnDatagram("uav1", summary, 200ms);
    EXPECT_EQ(TakeAll().size(), 1U);
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

TEST_F(TableExchanges, TakeEntriesAndSendNothingBack)
{
    TableCopy other("uav1", 1);
    other.Write("key", "value");
    _exchange.OnDatagram("uav1", EncodeTableEntries(other.Entries()).front(), 0s);
    EXPECT_THAT(TakeAll(), IsEmpty());
    EXPECT_EQ(_table.Entries(), other.Entries());
}

TEST_F(TableExchanges, DropDatagramsBeyond64ThatWait)
{
    for (int i = 0; i < 80; ++i)
    {
        _exchange.OnDigest("uav" + std::to_string(i), 7, 0s);
    }
    EXPECT_EQ(TakeAll().size(), 64U);
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
    good.push_back(EncodeTableSummary({.Salt = 1, .Hashes = _table.Hashes(1)}));
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
