#include <rabit/dynamic/DynamicType.h>
#include <rabit/mcap/McapWriter.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "Recording.h"
#include "SimulatedFlight.h"
#include "gateway/recording/MemoryFile.h"

namespace Rabit::WhatIf
{
namespace
{

using Json = nlohmann::ordered_json;
using Mcap::Bytes;
using Mcap::TextMap;

constexpr const char *Idl = "module Replayed { struct Value { sequence<octet> bytes; }; };";
constexpr const char *TypeName = "Replayed::Value";
constexpr Time Second = 1'000'000'000;
constexpr Time Start = 1'700'000'000 * Second;

// A recorded flight in a file. Times are seconds since its beginning.
class FlightRecording
{
public:
    FlightRecording() : _schema(_writer.AddSchema(TypeName, "omgidl", Idl)) {}

    void AddLife(const std::string &node, int life, double begin, double end, const std::string &text = "",
                 const std::string &domain = "")
    {
        _writer.AddMetadata({"rabit.recording",
                             {{"node", node},
                              {"life", std::to_string(life)},
                              {"domain", domain},
                              {"begin_ns", std::to_string(At(begin))},
                              {"end_ns", std::to_string(At(end))}}});
        if (!text.empty())
        {
            _writer.AddMetadata(
                {"rabit.configuration", {{"node", node}, {"life", std::to_string(life)}, {"text", text}}});
        }
    }
    std::uint16_t AddPosted(const std::string &node, const std::string &message)
    {
        return Add(node + "/" + message, {{"rabit.kind", "posted"},
                                          {"rabit.node", node},
                                          {"rabit.qos", "telemetry"},
                                          {"rabit.recorded_by", node}});
    }
    std::uint16_t AddKnew(const std::string &by, const std::string &node, const std::string &message)
    {
        return Add(by + "/Recorder/knew/" + node + "/" + message, {{"rabit.kind", "knew"},
                                                                   {"rabit.node", node},
                                                                   {"rabit.message", message},
                                                                   {"rabit.recorded_by", by}});
    }
    std::uint16_t AddSent(const std::string &node, const std::string &peer, const std::string &queue)
    {
        return Add(node + "/Recorder/sent/" + peer + "/" + queue, {{"rabit.kind", "queue sent"},
                                                                   {"rabit.node", node},
                                                                   {"rabit.peer", peer},
                                                                   {"rabit.queue", queue},
                                                                   {"rabit.recorded_by", node}});
    }
    std::uint16_t AddReceived(const std::string &node, const std::string &peer, const std::string &queue)
    {
        return Add(node + "/Recorder/received/" + peer + "/" + queue, {{"rabit.kind", "queue received"},
                                                                       {"rabit.node", node},
                                                                       {"rabit.peer", peer},
                                                                       {"rabit.queue", queue},
                                                                       {"rabit.recorded_by", node}});
    }
    void Put(std::uint16_t channel, double time, std::size_t size)
    {
        const auto type = DynamicType::Parse(Idl, TypeName).Type;
        const auto sample = *type->FromJsonValue({{"bytes", std::string((size + 2) / 3 * 4, 'A')}}).Sample;
        _writer.Add({channel, 0, At(time), At(time), sample});
    }
    void Save(const std::string &path)
    {
        _writer.Finish();
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char *>(_file.Content.data()),
                   static_cast<std::streamsize>(_file.Content.size()));
    }

private:
    static Time At(double time) { return Start + static_cast<Time>(time * static_cast<double>(Second)); }
    std::uint16_t Add(const std::string &topic, const TextMap &metadata)
    {
        return *_writer.AddChannel(_schema, topic, "cdr", metadata);
    }

    MemoryFile _file;
    Mcap::McapWriter _writer{_file, {}};
    const std::uint16_t _schema;
};

// Two nodes: uav posts Track ten times a second, which ground receives.
class Pair : public FlightRecording
{
public:
    explicit Pair(double seconds, const std::string &ofUav = "", std::size_t size = 100,
                  const std::string &domain = "")
    {
        AddLife("uav", 1, 0, seconds, ofUav, domain);
        AddLife("ground", 1, 0, seconds, "", domain);
        const std::uint16_t posted = AddPosted("uav", "Track");
        const std::uint16_t knew = AddKnew("ground", "uav", "Track");
        for (int tenth = 0; tenth <= 10 * seconds; ++tenth)
        {
            Put(posted, 0.1 * tenth, size);
            Put(knew, 0.1 * tenth, size);
        }
    }
};

class ReplayTest : public testing::Test
{
protected:
    ReplayTest()
    {
        std::string name = testing::TempDir() + "rabit_replay_XXXXXX";
        _folder = mkdtemp(name.data());
    }
    ~ReplayTest() override { std::filesystem::remove_all(_folder); }

    std::string Path() const { return _folder / "flight.mcap"; }

    std::vector<Json> Fly(const FlightSettings &settings = {}) const
    {
        std::vector<Json> facts;
        RabitLog::SetLevel(RabitLogLevel::Off);
        Recording recording({Path()});
        SimulatedFlight(recording, settings, [&](Json fact) { facts.push_back(std::move(fact)); }).Run();
        return facts;
    }

    static std::vector<Json> Only(const std::vector<Json> &facts, const std::string &kind)
    {
        std::vector<Json> found;
        std::copy_if(facts.begin(), facts.end(), std::back_inserter(found),
                     [&kind](const Json &fact) { return fact["fact"] == kind; });
        return found;
    }
    // Ages in seconds, at their arrival, of all values that came to others.
    static std::vector<double> Ages(const std::vector<Json> &facts)
    {
        std::vector<double> ages;
        for (const Json &fact : Only(facts, "values"))
        {
            for (std::size_t i = 0; !fact["own"] && i < fact["at"].size(); ++i)
            {
                ages.push_back(1e-9 * (fact["at"][i].get<double>() - fact["posted"][i].get<double>()));
            }
        }
        return ages;
    }

    std::filesystem::path _folder;
};

TEST_F(ReplayTest, EachPostIsMadeAtItsTimeAndArrives)
{
    Pair(10).Save(Path());
    const std::vector<Json> facts = Fly();
    EXPECT_EQ(facts.front()["end"], 10 * Second);
    const std::vector<Json> values = Only(facts, "values");
    const auto own = std::find_if(values.begin(), values.end(), [](const Json &fact) { return fact["own"]; });
    ASSERT_NE(own, values.end());
    EXPECT_EQ((*own)["at"].size(), 101U);  // also the last one, with which the recording ends
    ASSERT_GE((*own)["at"].size(), 51U);
    EXPECT_NEAR((*own)["at"][50].get<double>(), 5e9, 1e4);
    const std::vector<double> ages = Ages(facts);
    ASSERT_GE(ages.size(), 80U);
    EXPECT_LT(*std::max_element(ages.end() - 50, ages.end()), 0.01);
}

TEST_F(ReplayTest, AMessageThatIsNeverPostedHasNoValues)
{
    Pair(5,
         "node: uav\npublish: [{message: Track, type: \"Replayed::Value\", qos: telemetry}, {message: Never, "
         "type: \"Replayed::Value\", qos: state}]\n")
        .Save(Path());
    const std::vector<Json> values = Only(Fly(), "values");
    EXPECT_FALSE(values.empty());
    for (const Json &fact : values)
    {
        EXPECT_FALSE(fact["at"].empty()) << fact;
    }
}

TEST_F(ReplayTest, OverAThinRadioFewerArriveAndTheyAreOlder)
{
    Pair(30, "", 300).Save(Path());
    const std::vector<double> quick = Ages(Fly());
    std::vector<double> slow = Ages(Fly({.Medium = {.BytesPerSecond = 2000}}));
    EXPECT_LT(slow.size(), quick.size() * 3 / 4);
    std::nth_element(slow.begin(), slow.begin() + static_cast<std::ptrdiff_t>(slow.size() / 2), slow.end());
    EXPECT_GT(slow[slow.size() / 2], 0.15);  // 400 bytes at 2000 bytes a second
}

TEST_F(ReplayTest, EqualSeedsGiveEqualFactsAndOthersDoNot)
{
    Pair(20).Save(Path());
    const FlightSettings lossy = {.Faults = {.Loss = 0.3}, .Seed = 1};
    FlightSettings other = lossy;
    other.Seed = 2;
    EXPECT_EQ(Fly(lossy), Fly(lossy));
    EXPECT_NE(Fly(lossy), Fly(other));
}

TEST_F(ReplayTest, TheBudgetOfTheConfigurationHoldsUnlessAnotherIsGiven)
{
    Pair(20,
         "node: uav\nradio: {budget: 1500B/s}\npublish: [{message: Track, type: \"Replayed::Value\", qos: "
         "telemetry}]\n",
         500)
        .Save(Path());
    const auto replaced = [this](const FlightSettings &settings)
    {
        const std::vector<Json> counts = Only(Fly(settings), "publication");
        return counts.back()["replaced"].get<int>();
    };
    EXPECT_GT(replaced({}), 100);
    EXPECT_EQ(replaced({.Budget = 0.0}), 0);
}

TEST_F(ReplayTest, OfSeveralPathsTheFirstIsFlown)
{
    Pair(5,
         "node: uav\npaths: [{name: mesh, interfaces: [mesh0], radio: {budget: 1500B/s}}, {name: modem, "
         "interfaces: [modem0]}]\n"
         "security: {keys: /nowhere}\nrecord: {folder: /nowhere}\n")
        .Save(Path());
    const Recording recording({Path()});
    const auto uav = std::find_if(recording.Lives().begin(), recording.Lives().end(),
                                  [](const RecordedLife &life) { return life.Node == "uav"; });
    EXPECT_EQ(uav->Config.Radio.Budget, 1500);
    EXPECT_TRUE(uav->Config.Paths.empty() && uav->Config.Interfaces.empty());
    EXPECT_FALSE(uav->Config.Security || uav->Config.Record);
    EXPECT_FALSE(Ages(Fly()).empty());
}

TEST_F(ReplayTest, ANodeThatEndedIsLostAndIsBackInItsNextLife)
{
    Pair recording(40);
    recording.AddLife("other", 1, 0, 10);
    recording.AddLife("other", 2, 25, 40);
    recording.Save(Path());
    std::vector<std::string> states;
    const std::vector<Json> facts = Fly();
    for (const Json &fact : Only(facts, "peer"))
    {
        if (fact["of"] == "other" && fact["file"].get<std::string>().starts_with("ground"))
        {
            states.push_back(fact["state"]);
        }
    }
    EXPECT_THAT(states, testing::AllOf(testing::Contains("LOST"), testing::Not(testing::IsEmpty())));
    EXPECT_EQ(states.back(), "UP");
    EXPECT_EQ(Only(facts, "life").size(), 4U);
}

TEST_F(ReplayTest, QueueMessagesAreSentAgainAndTheirOutcomesAreTold)
{
    Pair recording(
        20,
        "node: uav\naccept: [{queue: Orders, types: [\"Replayed::Value\"]}]\npublish: [{message: Track, "
        "type: \"Replayed::Value\", qos: telemetry}]\n");
    const std::uint16_t orders = recording.AddSent("ground", "uav", "Orders");
    const std::uint16_t others = recording.AddSent("ground", "uav", "Others");
    recording.Put(orders, 10, 20);
    recording.Put(orders, 11, 20);
    recording.Put(others, 12, 20);
    recording.Save(Path());
    const std::vector<Json> queues = Only(Fly({.Faults = {.Delay = std::chrono::milliseconds(50)}}), "queue");
    ASSERT_EQ(queues.size(), 2U);
    EXPECT_EQ(queues[0]["sent"], 2);
    EXPECT_EQ(queues[0]["outcomes"]["delivered"], 2);
    ASSERT_EQ(queues[0]["ages"].size(), 2U);
    EXPECT_NEAR(queues[0]["ages"][1].get<double>(), 5e7, 1e7);  // the first one opens the link
    EXPECT_EQ(queues[1]["refused"], 1);                         // uav has no such queue
}

TEST_F(ReplayTest, ANodeThatDidNotRecordSendsTheMessagesThatOthersReceived)
{
    Pair recording(20, "node: uav\ndomain: 7\naccept: [{queue: Orders, types: [\"Replayed::Value\"]}]\n", 100,
                   "7");
    recording.Put(recording.AddReceived("uav", "tool", "Orders"), 12, 20);
    recording.Save(Path());
    const std::vector<Json> facts = Fly();
    const std::vector<Json> queues = Only(facts, "queue");
    ASSERT_EQ(queues.size(), 1U);
    EXPECT_EQ(queues[0]["from"], "tool");
    EXPECT_EQ(queues[0]["outcomes"]["delivered"], 1);
    EXPECT_EQ(Only(facts, "note").size(), 1U);
}

TEST_F(ReplayTest, AConfigurationThatIsNotAcceptedIsNotedAndTheFlightGoesOn)
{
    Pair(5, "node: uav\nfuture_key: 3\n").Save(Path());
    const std::vector<Json> facts = Fly();
    ASSERT_EQ(Only(facts, "note").size(), 1U);
    EXPECT_THAT(Only(facts, "note")[0]["text"].get<std::string>(), testing::HasSubstr("future_key"));
    EXPECT_FALSE(Ages(facts).empty());
}

TEST_F(ReplayTest, TheArrivalsOfTheRecordedFlightAreTold)
{
    Pair(3).Save(Path());
    const std::vector<Json> flown = Only(Fly(), "flown");
    ASSERT_EQ(flown.size(), 1U);
    EXPECT_EQ(flown[0]["at"], "ground");
    EXPECT_EQ(flown[0]["node"], "uav");
    EXPECT_GE(flown[0]["arrived"].size(), 30U);
}

TEST_F(ReplayTest, AFileThatIsNoRecordingOrHasNoNodesIsRefused)
{
    std::ofstream(Path()) << "text";
    EXPECT_THROW(Recording({Path()}), std::runtime_error);
    FlightRecording().Save(Path());
    EXPECT_THROW(Recording({Path()}), std::runtime_error);
}

TEST_F(ReplayTest, ARecordingThatClaimsToLastYearsIsRefused)
{
    FlightRecording recording;
    recording.AddLife("uav", 1, 0, 1);
    const std::uint16_t posted = recording.AddPosted("uav", "Track");
    recording.Put(posted, 0, 10);
    recording.Put(posted, 1e8, 10);
    recording.Save(Path());
    EXPECT_THROW(Recording({Path()}), std::runtime_error);
}

TEST_F(ReplayTest, ARecordingThatClaimsManyNodesForADayIsRefused)
{
    FlightRecording recording;
    for (int node = 0; node < 1000; ++node)
    {
        recording.AddLife("uav" + std::to_string(node), 1, 0, 86000);
    }
    const std::uint16_t posted = recording.AddPosted("uav1", "Track");
    recording.Put(posted, 0, 10);
    recording.Put(posted, 86000, 10);
    recording.Save(Path());
    EXPECT_THROW(Recording({Path()}), std::runtime_error);
}

// A sender and a receiver. All messages are equal.
class FlightTapTest : public testing::Test
{
protected:
    std::unique_ptr<FlightTap> Tap(const std::string &node) const
    {
        return std::make_unique<FlightTap>(node, _clock, Nanoseconds(0), _book);
    }
    static GatewayTap::QueueMessage To(std::string_view node, std::uint64_t id)
    {
        return {.Node = node, .Queue = "Orders", .Type = TypeName, .Id = id, .Sample = {}};
    }
    void Pass(int seconds) const { _clock->Advance(std::chrono::seconds(seconds)); }
    const std::vector<Nanoseconds> &Ages() const { return _book->Links.at({"ground", "uav", "Orders"}).Ages; }

    const std::shared_ptr<ManualClock> _clock = std::make_shared<ManualClock>();
    const std::shared_ptr<QueueBook> _book = std::make_shared<QueueBook>();
    std::unique_ptr<FlightTap> _ground = Tap("ground");
    const std::unique_ptr<FlightTap> _uav = Tap("uav");
};

TEST_F(FlightTapTest, AMessageHasNotTheAgeOfAnEqualOneThatExpired)
{
    _ground->Sent(To("uav", 1));
    Pass(5);
    _ground->Settled("uav", "Orders", 1, QueueOutcome::Expired);
    _ground->Sent(To("uav", 2));
    Pass(1);
    _uav->Received(To("ground", 0));
    EXPECT_THAT(Ages(), testing::ElementsAre(std::chrono::seconds(1)));
}

TEST_F(FlightTapTest, AMessageHasNotTheAgeOfAnEqualOneThatExpiredBeforeItWasTold)
{
    _ground->Settled("uav", "Orders", 1, QueueOutcome::Expired);
    _ground->Sent(To("uav", 1));
    Pass(5);
    _ground->Sent(To("uav", 2));
    Pass(1);
    _uav->Received(To("ground", 0));
    EXPECT_THAT(Ages(), testing::ElementsAre(std::chrono::seconds(1)));
}

TEST_F(FlightTapTest, AMessageHasNotTheAgeOfAnEqualOneOfAnEarlierIncarnation)
{
    _ground->Sent(To("uav", 1));
    Pass(5);
    _ground.reset();
    _ground = Tap("ground");
    _ground->Sent(To("uav", 1));
    Pass(1);
    _uav->Received(To("ground", 0));
    EXPECT_THAT(Ages(), testing::ElementsAre(std::chrono::seconds(1)));
}

}  // namespace
}  // namespace Rabit::WhatIf
