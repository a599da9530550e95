#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "SimRandom.h"
#include "TableFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

const std::vector<std::string> FiveNodes = {"ground", "uav1", "uav2", "uav3", "uav4"};

// All that nodes said, and what each said last.
struct TableOracle
{
    NumberSet Numbers;
    std::int64_t Highest = -1000;
    std::map<std::string, std::string> States;
};

std::string StateKeyOf(const std::string &name)
{
    return "state " + name;
}

// A node writes its own state, and one of the keys that all write.
void WriteSomething(TableFleet &fleet, const std::string &name, Sim::SimRandom &random, TableOracle &oracle)
{
    TableCopy &table = fleet[name];
    const std::string state = std::to_string(random.Index(1000));
    table.Write(StateKeyOf(name), state);
    oracle.States[name] = state;
    const std::size_t number = random.Index(512);
    switch (random.Index(6))
    {
        case 0:
            table.Add("flown", number);
            oracle.Numbers.set(number);
            break;
        case 1:
            table.Raise("round", static_cast<std::int64_t>(number));
            oracle.Highest = std::max(oracle.Highest, static_cast<std::int64_t>(number));
            break;
        case 2:
            table.Write("all", state);
            break;
        // Nodes that have not met may take different merges. Those that have are refused.
        case 3:
            table.Write("mixed", state);
            break;
        case 4:
            table.Add("mixed", number);
            break;
        default:
            table.Raise("mixed", 1);
            break;
    }
}

// Half a minute of random writes and faults. If there are restarts, a node may start with any incarnation,
// and writes its state at once.
TableOracle FlyTables(TableFleet &fleet, std::uint64_t seed, bool restarts)
{
    Sim::SimRandom random(seed + 1'000'000);
    TableOracle oracle;
    fleet.Air.Loss = random.Unit() * 0.6;
    fleet.Air.Repeats = random.Unit() * 0.3;
    fleet.Air.Longest = random.LogBetween(std::chrono::nanoseconds(2ms), std::chrono::nanoseconds(500ms));
    for (int step = 0; step < 40; ++step)
    {
        const std::string &name = fleet.Names()[random.Index(fleet.Names().size())];
        switch (random.Index(8))
        {
            case 0:
                fleet.Place(name, static_cast<int>(random.Index(3)));
                break;
            case 1:
                fleet.Join();
                break;
            case 2:
                fleet.Block(name, fleet.Names()[random.Index(fleet.Names().size())]);
                break;
            case 3:
                if (restarts)
                {
                    fleet.Start(name, random.Index(20));
                }
                WriteSomething(fleet, name, random, oracle);
                break;
            default:
                WriteSomething(fleet, name, random, oracle);
                break;
        }
        fleet.RunFor(random.LogBetween(std::chrono::nanoseconds(10ms), std::chrono::nanoseconds(4s)));
    }
    // The last cut: no node hears another one, until each takes the others for LOST.
    fleet.Part();
    for (const std::string &name : fleet.Names())
    {
        WriteSomething(fleet, name, random, oracle);
    }
    fleet.RunFor(4s);
    fleet.Join();
    fleet.Air = {.Longest = 50ms};
    return oracle;
}

TEST(Tables, AreEqualThreeBeatsAfterTheLastCutAndHaveAllThatWasSaid)
{
    for (std::uint64_t seed = 1; seed <= 200; ++seed)
    {
        TableFleet fleet(FiveNodes, seed);
        const TableOracle oracle = FlyTables(fleet, seed, false);
        fleet.RunFor(3 * TableFleet::Beat);
        ASSERT_TRUE(fleet.AreEqual()) << "seed " << seed;
        TableCopy &table = fleet["ground"];
        if (oracle.Numbers.any())
        {
            ASSERT_EQ(std::get<NumberSet>(*table.Find("flown")), oracle.Numbers) << "seed " << seed;
        }
        if (oracle.Highest >= 0)
        {
            ASSERT_EQ(std::get<std::int64_t>(*table.Find("round")), oracle.Highest) << "seed " << seed;
        }
        for (const auto &[name, state] : oracle.States)
        {
            ASSERT_EQ(std::get<LastWritten>(*table.Find(StateKeyOf(name))).Value, state) << "seed " << seed;
        }
    }
}

TEST(Tables, HaveTheLastStateOfEachNodeThoughItsIncarnationsFall)
{
    for (std::uint64_t seed = 1; seed <= 200; ++seed)
    {
        TableFleet fleet(FiveNodes, seed);
        const TableOracle oracle = FlyTables(fleet, seed, true);
        fleet.RunFor(3 * TableFleet::Beat);
        ASSERT_TRUE(fleet.AreEqual()) << "seed " << seed;
        for (const auto &[name, state] : oracle.States)
        {
            ASSERT_EQ(std::get<LastWritten>(*fleet["ground"].Find(StateKeyOf(name))).Value, state)
                << "seed " << seed;
        }
    }
}

TEST(Tables, AreEqualWithinEightBeatsThoughAFifthIsLost)
{
    for (std::uint64_t seed = 1; seed <= 200; ++seed)
    {
        TableFleet fleet(FiveNodes, seed);
        fleet.Air = {.Loss = 0.2, .Repeats = 0.1, .Longest = 50ms};
        for (const std::string &name : FiveNodes)
        {
            fleet[name].Write(StateKeyOf(name), "here");
            fleet[name].Write("all", name);
        }
        fleet.RunFor(8 * TableFleet::Beat);
        ASSERT_TRUE(fleet.AreEqual()) << "seed " << seed;
    }
}

TEST(Tables, TravelOverNodesBetween)
{
    TableFleet fleet({"a", "b", "c"}, 1);
    fleet.Block("a", "c");
    fleet.Block("c", "a");
    fleet["a"].Write("from a", "1");
    fleet["c"].Write("from c", "2");
    fleet.RunFor(3 * TableFleet::Beat);
    EXPECT_TRUE(fleet.AreEqual());
    EXPECT_NE(fleet["c"].Find("from a"), nullptr);
}

TEST(Tables, CostNothingOnceTheyAreEqual)
{
    TableFleet fleet(FiveNodes, 2);
    fleet["uav1"].Write("key", "value");
    fleet.RunFor(3 * TableFleet::Beat);
    ASSERT_TRUE(fleet.AreEqual());
    const std::size_t sent = fleet.Sent;
    EXPECT_GT(sent, 0U);
    fleet.RunFor(60s);
    EXPECT_EQ(fleet.Sent, sent);
}

TEST(Tables, CostNothingInACut)
{
    TableFleet fleet(FiveNodes, 3);
    fleet.Part();
    for (const std::string &name : FiveNodes)
    {
        fleet[name].Write(StateKeyOf(name), "alone");
    }
    fleet.RunFor(60s);
    EXPECT_EQ(fleet.Sent, 0U);
}

// 256 keys of 64 bytes with values of 64 bytes.
TEST(Tables, OfTheLargestSizeAreEqualWithinThreeBeatsInDatagramsOf1200Bytes)
{
    TableFleet fleet({"a", "b"}, 4);
    for (std::size_t i = 0; i < TableCopy::MostKeys; ++i)
    {
        std::string key = std::to_string(i);
        key.resize(TableEntry::LongestKey, 'k');
        ASSERT_EQ(fleet["a"].Write(key, std::string(TableEntry::LongestValue, 'v')), TableCopy::Answer::Done);
    }
    fleet.RunFor(3 * TableFleet::Beat);
    EXPECT_TRUE(fleet.AreEqual());
    EXPECT_LE(fleet.LongestSent, 1200U);
}

TEST(Tables, WithTooManyKeysInTheFleetStayFullAndAskEverySixteenSeconds)
{
    TableFleet fleet({"a", "b"}, 5);
    for (int i = 0; i < 200; ++i)
    {
        fleet["a"].Raise("a" + std::to_string(i), i);
        fleet["b"].Raise("b" + std::to_string(i), i);
    }
    fleet.RunFor(60s);
    EXPECT_EQ(fleet["a"].Entries().size(), TableCopy::MostKeys);
    EXPECT_EQ(fleet["b"].Entries().size(), TableCopy::MostKeys);
    EXPECT_TRUE(fleet["a"].TakeRefusal());
    EXPECT_TRUE(fleet["b"].TakeRefusal());
    fleet.Sent = 0;
    fleet.RunFor(320s);
    // Two nodes, a summary and two datagrams of entries, 20 times and once more.
    EXPECT_LE(fleet.Sent, 126U);
    EXPECT_GT(fleet.Sent, 0U);
}

}  // namespace
}  // namespace Rabit
