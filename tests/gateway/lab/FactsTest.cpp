#include "FlightFile.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/mcap/McapWriter.h>

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "gateway/recording/MemoryFile.h"

namespace Rabit::Facts
{
namespace
{

using Json = nlohmann::ordered_json;
using Mcap::Bytes;

Bytes Encoded(const Gateway::Fleet &fleet)
{
    const MessageType &type = *MessageTypeRegistry::Of(fleet);
    Bytes bytes(type.SerializedSize(fleet));
    bytes.resize(type.Serialize(fleet, bytes));
    return bytes;
}

Gateway::Fleet FleetWith(Gateway::NodeState state, std::uint64_t incarnation = 5)
{
    Gateway::Fleet fleet;
    fleet.node = "ground";
    fleet.incarnation = 3;
    fleet.nodes.emplace_back();
    fleet.nodes.back().node = "uav1";
    fleet.nodes.back().state = state;
    fleet.nodes.back().incarnation = incarnation;
    return fleet;
}

std::vector<std::string> NamesOf(const std::vector<Json> &facts)
{
    std::vector<std::string> names;
    for (const Json &fact : facts)
    {
        names.push_back(fact["fact"]);
    }
    return names;
}

TEST(FleetFactsTest, OnlyChangesAreTold)
{
    FleetFacts facts;
    EXPECT_EQ(NamesOf(facts.Look(Encoded(FleetWith(Gateway::NodeState::UP)))),
              (std::vector<std::string>{"self", "peer", "air"}));
    EXPECT_EQ(NamesOf(facts.Look(Encoded(FleetWith(Gateway::NodeState::UP)))),
              (std::vector<std::string>{"air"}));
    const std::vector<Json> lost = facts.Look(Encoded(FleetWith(Gateway::NodeState::LOST)));
    ASSERT_EQ(lost.size(), 2U);
    EXPECT_EQ(lost[0]["of"], "uav1");
    EXPECT_EQ(lost[0]["state"], "LOST");
    EXPECT_EQ(facts.Look(Encoded(FleetWith(Gateway::NodeState::LOST, 6)))[0]["incarnation"], "6");
}

TEST(FleetFactsTest, CountsOfAPublicationAreToldWhenTheyChange)
{
    FleetFacts facts;
    Gateway::Fleet fleet = FleetWith(Gateway::NodeState::UP);
    fleet.publications.emplace_back();
    fleet.publications.back().message = "Pose";
    fleet.publications.back().offered = 7;
    EXPECT_EQ(facts.Look(Encoded(fleet)).back()["offered"], 7);
    EXPECT_EQ(NamesOf(facts.Look(Encoded(fleet))), (std::vector<std::string>{"air"}));
    fleet.publications.back().replaced = 2;
    EXPECT_EQ(facts.Look(Encoded(fleet)).back()["replaced"], 2);
}

TEST(FleetFactsTest, AProblemIsToldWhenItComesAndWhenItIsSolved)
{
    FleetFacts facts;
    facts.Look(Encoded(FleetWith(Gateway::NodeState::UP)));
    Gateway::Fleet fleet = FleetWith(Gateway::NodeState::UP);
    fleet.problems.push_back({"subscribe Pose", "uav1", "another type"});
    EXPECT_EQ(facts.Look(Encoded(fleet))[0]["reason"], "another type");
    EXPECT_EQ(NamesOf(facts.Look(Encoded(fleet))), (std::vector<std::string>{"air"}));
    EXPECT_EQ(facts.Look(Encoded(FleetWith(Gateway::NodeState::UP)))[0]["fact"], "solved");
}

TEST(FleetFactsTest, BytesThatAreNoFleetTellNothing)
{
    EXPECT_TRUE(FleetFacts().Look(Bytes{1, 2, 3}).empty());
}

// A file that grows.
class FlightFileTest : public testing::Test
{
protected:
    FlightFileTest()
    {
        std::string name = testing::TempDir() + "rabit_flight_XXXXXX";
        _folder = mkdtemp(name.data());
    }
    ~FlightFileTest() override { std::filesystem::remove_all(_folder); }

    void Grow(const Bytes &content, std::size_t until)
    {
        std::ofstream(Path(), std::ios::binary)
            .write(reinterpret_cast<const char *>(content.data()), static_cast<std::streamsize>(until));
    }
    std::string Path() const { return _folder / "a.mcap"; }

    std::filesystem::path _folder;
    std::set<std::string> _fields;
};

TEST_F(FlightFileTest, ValuesAreToldOnceAsTheFileGrowsAndAtAnyByte)
{
    MemoryFile content;
    Mcap::McapWriter writer(content, {"rabit test", "rabit", true});
    writer.AddMetadata({"rabit.node", {{"domain", "7"}, {"transport", "fastdds"}}});
    const std::uint16_t schema = writer.AddSchema("Uav::Pose", "omgidl", "module Uav {};");
    const std::uint16_t pose =
        *writer.AddChannel(schema, "uav1/Pose", "cdr", {{"rabit.kind", "mirrored"}, {"rabit.node", "uav1"}});
    const Bytes data(40, 1);
    for (std::uint64_t time = 1000; time < 1006; ++time)
    {
        writer.Add({pose, 0, time, time - 10, data});
        writer.FinishChunks();
    }
    writer.Finish();

    FlightFile file(Path(), _fields);
    std::vector<std::uint64_t> at;
    std::vector<std::uint64_t> posted;
    std::size_t about = 0;
    for (std::size_t size = 0; size <= content.Content.size(); size += 7)
    {
        Grow(content.Content, std::min(size, content.Content.size()));
        file.Follow(
            [&](const Json &fact)
            {
                EXPECT_EQ(fact["file"], Path());
                if (fact["fact"] == "about")
                {
                    ++about;
                    EXPECT_EQ(fact["domain"], "7");
                    return;
                }
                EXPECT_EQ(fact["fact"], "values");
                EXPECT_EQ(fact["node"], "uav1");
                EXPECT_EQ(fact["message"], "Pose");
                EXPECT_EQ(fact["own"], false);
                at.insert(at.end(), fact["at"].begin(), fact["at"].end());
                posted.insert(posted.end(), fact["posted"].begin(), fact["posted"].end());
            });
    }
    EXPECT_EQ(at, (std::vector<std::uint64_t>{1000, 1001, 1002, 1003, 1004, 1005}));
    EXPECT_EQ(posted.front(), 990U);
    EXPECT_EQ(about, 1U);
}

TEST_F(FlightFileTest, OfTheRecordersOwnChannelsTheLogIsTold)
{
    MemoryFile content;
    Mcap::McapWriter writer(content, {"rabit test", "rabit", true});
    const Mcap::TextMap recorder{{"rabit.kind", "recorder"}, {"rabit.node", "uav1"}};
    const auto put = [&](const std::string &topic, const std::string &json)
    {
        const auto channel = *writer.AddChannel(0, topic, "json", recorder);
        writer.Add({channel, 0, 1000, 1000, Bytes(json.begin(), json.end())});
    };
    put("uav1/Recorder/Log", R"({"level":3,"message":"low battery"})");
    put("uav1/Recorder/Status", R"({"message":"of no log"})");
    writer.Finish();
    Grow(content.Content, content.Content.size());
    std::vector<Json> facts;
    FlightFile(Path(), _fields).Follow([&](const Json &fact) { facts.push_back(fact); });
    ASSERT_EQ(facts.size(), 1U);
    EXPECT_EQ(facts[0]["fact"], "log");
    EXPECT_EQ(facts[0]["text"], "low battery");
}

TEST_F(FlightFileTest, AFileThatIsNotThereOrIsNoRecordingTellsNothing)
{
    FlightFile file(Path(), _fields);
    file.Follow([](const Json &) { ADD_FAILURE(); });
    Grow(Bytes(100, 0xFF), 100);
    file.Follow([](const Json &) { ADD_FAILURE(); });
}

}  // namespace
}  // namespace Rabit::Facts
