// Tests of the parts that all backends share.
#include <gmock/gmock.h>
#include <rabit/base/Assert.h>
#include <rabit/transport/FleetMember.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "common/HandlerGate.h"
#include "common/InstanceTable.h"
#include "common/ParticipantIdentity.h"
#include "common/PeerAddress.h"
#include "common/SettingsCheck.h"
#include "common/TopicRegistry.h"
#include "common/UseGate.h"

namespace
{

using namespace Rabit;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<std::uint8_t> ToBytes(const std::string &text)
{
    return {text.begin(), text.end()};
}

TransportSettings SettingsThatLogTo(std::vector<std::string> &lines)
{
    TransportSettings settings;
    settings.Node = "uav1";
    settings.Log = [&lines](const std::string &line) { lines.push_back(line); };
    return settings;
}

TEST(ParticipantIdentity, IncarnationSurvivesTheUserData)
{
    for (const std::uint64_t incarnation : {0ull, 1ull, 18446744073709551615ull})
    {
        EXPECT_EQ(ParseUserData(ToBytes(MakeUserData(incarnation))), incarnation);
    }
}

TEST(ParticipantIdentity, OtherUserDataIsNotARabitNode)
{
    for (const char *text : {"", "enclave=/;", "rabit=1;", "rabit=1;incarnation=", "rabit=1;incarnation=;",
                             "rabit=1;incarnation=12", "rabit=1;incarnation=18446744073709551616;",
                             "rabit=1;incarnation=-1;", "rabit=2;incarnation=1;"})
    {
        EXPECT_EQ(ParseUserData(ToBytes(text)), std::nullopt) << text;
    }
}

TEST(InstanceTable, TellsAnInstanceOnlyWhenItsLastWriterIsGone)
{
    InstanceTable table;
    table.Alive({7}, {1});
    table.Alive({7}, {2});
    table.Alive({8}, {2});
    EXPECT_THAT(table.WriterGone({1}), IsEmpty());
    EXPECT_THAT(table.WriterGone({2}), ElementsAre(KeyHash{7}, KeyHash{8}));
    EXPECT_THAT(table.WriterGone({2}), IsEmpty());
}

TEST(InstanceTable, ForgetsDisposedAndUnregisteredInstances)
{
    InstanceTable table;
    table.Alive({7}, {1});
    table.Disposed({7});
    table.Alive({8}, {1});
    EXPECT_FALSE(table.Unregistered({8}, {2}));
    EXPECT_TRUE(table.Unregistered({8}, {1}));
    EXPECT_FALSE(table.Unregistered({8}, {1}));
    EXPECT_THAT(table.WriterGone({1}), IsEmpty());
}

TEST(HandlerGate, CountsAndLogsWhatAHandlerThrows)
{
    std::vector<std::string> lines;
    const auto log = std::make_shared<SessionLog>(SettingsThatLogTo(lines));
    HandlerGate gate(log, "the reader of Pose");
    gate.Run([] { throw std::runtime_error("no battery"); });
    gate.Run([] { throw 7; });
    EXPECT_EQ(log->Read().HandlerExceptions, 2u);
    ASSERT_THAT(lines, SizeIs(2));
    EXPECT_THAT(lines[0], HasSubstr("the reader of Pose threw: no battery"));
}

TEST(HandlerGate, RunsNothingOnceClosed)
{
    std::vector<std::string> lines;
    HandlerGate gate(std::make_shared<SessionLog>(SettingsThatLogTo(lines)), "the reader of Pose");
    gate.Close();
    bool ran = false;
    gate.Run([&] { ran = true; });
    EXPECT_FALSE(ran);
}

TEST(HandlerGate, ClosingWaitsForTheWorkThatRuns)
{
    std::vector<std::string> lines;
    HandlerGate gate(std::make_shared<SessionLog>(SettingsThatLogTo(lines)), "the reader of Pose");
    std::atomic<bool> entered{false};
    std::atomic<bool> closing{false};
    std::atomic<bool> left{false};
    std::jthread worker(
        [&]
        {
            gate.Run(
                [&]
                {
                    entered = true;
                    while (!closing)
                    {
                        std::this_thread::yield();
                    }
                    for (int i = 0; i < 1000; ++i)
                    {
                        std::this_thread::yield();
                    }
                    left = true;
                });
        });
    while (!entered)
    {
        std::this_thread::yield();
    }
    closing = true;
    gate.Close();
    EXPECT_TRUE(left);
}

TEST(SessionLog, LogsARepeatedFaultLessAndLessOften)
{
    std::vector<std::string> lines;
    SessionLog log(SettingsThatLogTo(lines));
    for (int i = 0; i < 1000; ++i)
    {
        log.WriteTimedOut("Pose");
    }
    EXPECT_EQ(log.Read().WriteTimeouts, 1000u);
    EXPECT_THAT(lines, SizeIs(10));  // 1, 2, 4 ... 512
}

TEST(SessionLog, SurvivesASinkThatThrows)
{
    TransportSettings settings;
    settings.Log = [](const std::string &) { throw std::runtime_error("disk full"); };
    SessionLog log(settings);
    log.WriteTimedOut("Pose");
    EXPECT_EQ(log.Read().WriteTimeouts, 1u);
}

// A neighbour chooses its names, and lines go to terminals and journals.
TEST(SessionLog, WritesForeignNamesAsOneLineOfPrintableText)
{
    std::vector<std::string> lines;
    SessionLog log(SettingsThatLogTo(lines));
    log.InconsistentType("Pose", "Uav::Pose", "\x1b[2J\nrabit: error: \x9b\x7f\xff", "uav\r1");
    ASSERT_THAT(lines, SizeIs(1));
    EXPECT_THAT(lines[0],
                HasSubstr("topic Pose has type Uav::Pose here, but ?[2J?rabit: error: ??? at uav?1"));
}

TEST(SessionLog, CutsALongLine)
{
    std::vector<std::string> lines;
    SessionLog log(SettingsThatLogTo(lines));
    log.Line(std::string(100'000, 'x'));
    ASSERT_THAT(lines, SizeIs(1));
    EXPECT_THAT(lines[0], testing::EndsWith("xxx... (cut)"));
    EXPECT_THAT(lines[0], SizeIs(testing::Le(SessionLog::LongestLine)));
}

TEST(TopicRegistry, RefusesAnotherTypeAsLongAsTheTopicIsOpen)
{
    std::vector<std::string> lines;
    TopicRegistry topics(std::make_shared<SessionLog>(SettingsThatLogTo(lines)));
    {
        const TopicRegistry::Use first(topics, {"Pose", "Uav::Pose", {}});
        const TopicRegistry::Use second(topics, {"Pose", "Uav::Pose", {}});
        EXPECT_THROW(TopicRegistry::Use(topics, {"Pose", "Uav::Goto", {}}), TransportError);
    }
    EXPECT_NO_THROW(TopicRegistry::Use(topics, {"Pose", "Uav::Goto", {}}));
}

TEST(TopicRegistry, RefusesNamesThatDdsCannotCarry)
{
    std::vector<std::string> lines;
    TopicRegistry topics(std::make_shared<SessionLog>(SettingsThatLogTo(lines)));
    EXPECT_THROW(TopicRegistry::Use(topics, {"", "Uav::Pose", {}}), TransportError);
    EXPECT_THROW(TopicRegistry::Use(topics, {std::string(256, 'x'), "Uav::Pose", {}}), TransportError);
    EXPECT_THROW(TopicRegistry::Use(topics, {"Pose", "", {}}), TransportError);
    EXPECT_THROW(TopicRegistry::Use(topics, {std::string("a\0b", 3), "Uav::Pose", {}}), TransportError);
}

TEST(TopicRegistry, CountsATypeThatDiffersElsewhereWhicheverCameFirst)
{
    std::vector<std::string> lines;
    const auto log = std::make_shared<SessionLog>(SettingsThatLogTo(lines));
    TopicRegistry topics(log);
    topics.RemoteAppeared({.Id = {1}, .Topic = "Pose", .Type = "Uav::Goto", .Node = "uav1"});
    EXPECT_EQ(log->Read().InconsistentTypes, 0u);
    const TopicRegistry::Use use(topics, {"Pose", "Uav::Pose", {}});
    EXPECT_EQ(log->Read().InconsistentTypes, 1u);
    topics.RemoteAppeared({.Id = {2}, .Topic = "Pose", .Type = "Uav::Pose"});
    topics.RemoteAppeared({.Id = {3}, .Topic = "Pose", .Type = "Uav::State"});
    EXPECT_EQ(log->Read().InconsistentTypes, 2u);
    EXPECT_THAT(lines.back(), HasSubstr("topic Pose has type Uav::Pose here, but Uav::State elsewhere"));
}

TEST(Settings, OutOfRangeIsRefused)
{
    TransportSettings good;
    good.Node = "uav1";
    EXPECT_NO_THROW(CheckSettings(good));
    auto bad = [&](auto change)
    {
        TransportSettings settings = good;
        change(settings);
        return settings;
    };
    EXPECT_THROW(CheckSettings(bad([](auto &s) { s.Node = ""; })), TransportError);
    EXPECT_THROW(CheckSettings(bad([](auto &s) { s.Node = std::string(201, 'x'); })), TransportError);
    EXPECT_THROW(CheckSettings(bad([](auto &s) { s.Domain = -1; })), TransportError);
    EXPECT_THROW(CheckSettings(bad([](auto &s) { s.Domain = 233; })), TransportError);
    EXPECT_THROW(CheckSettings(bad([](auto &s) { s.MaxDatagram = 999; })), TransportError);
    EXPECT_THROW(CheckSettings(bad([](auto &s) { s.MaxDatagram = 65001; })), TransportError);
    EXPECT_THROW(CheckSettings(bad([](auto &s) { s.Interfaces = {"fe80::1"}; })), TransportError);
    EXPECT_THROW(CheckSettings(bad([](auto &s) { s.Interfaces = {"::1%eth0"}; })), TransportError);
    EXPECT_NO_THROW(CheckSettings(bad([](auto &s) { s.Interfaces = {"eth0:1"}; }))) << "a label of Linux";
    EXPECT_THROW(CheckSettings(bad([](auto &s) { s.Lease = s.AnnouncementPeriod; })), TransportError);
    EXPECT_THROW(CheckSettings(bad([](auto &s) { s.AnnouncementPeriod = std::chrono::milliseconds(0); })),
                 TransportError);
}

class MemberNamedUav1 final : public FleetMember
{
public:
    const std::string &Name() const override { return _name; }
    std::vector<SettingsProblem> Problems() const override { return {}; }

private:
    const std::string _name = "uav1";
};

TransportSettings SettingsOfAMember(const std::string &node)
{
    TransportSettings settings;
    settings.Node = node;
    settings.Member = std::make_shared<MemberNamedUav1>();
    return settings;
}

TEST(Settings, AMemberHasTheNameInItsKeys)
{
    EXPECT_NO_THROW(CheckSettings(SettingsOfAMember("uav1")));
    const auto problems = FindImpossible(SettingsOfAMember("uav2"));
    ASSERT_THAT(problems, SizeIs(1));
    EXPECT_EQ(problems[0].Setting, "security");
    EXPECT_THAT(problems[0].Text, HasSubstr("uav1"));
}

TEST(Settings, AnInterfaceThatCanBeNoneIsImpossible)
{
    TransportSettings settings;
    settings.Node = "uav1";
    settings.Interfaces = {"eth0", "10.0.0.1", "radio/0", "", "10.0.0.256", "averylongname016", "a b"};
    std::vector<std::string> refused;
    for (const SettingsProblem &problem : FindImpossible(settings))
    {
        EXPECT_TRUE(problem.Impossible);
        EXPECT_EQ(problem.Setting, "interfaces");
        refused.push_back(problem.Entry);
    }
    EXPECT_THAT(refused, ElementsAre("radio/0", "", "10.0.0.256", "averylongname016", "a b"));
}

TEST(Settings, EachPeerThatCanBeNoneIsImpossible)
{
    TransportSettings settings;
    settings.Node = "uav1";
    settings.Peers = {"ground", "ground:port", "10.0.0.1:7410"};
    const auto problems = FindImpossible(settings);
    ASSERT_THAT(problems, SizeIs(1));
    EXPECT_EQ(problems[0].Setting, "peers");
    EXPECT_EQ(problems[0].Entry, "ground:port");
}

TEST(Settings, PeersAreParsed)
{
    EXPECT_EQ(ParsePeer("127.0.0.1").Host, "127.0.0.1");
    EXPECT_EQ(ParsePeer("127.0.0.1").Port, 0);
    EXPECT_EQ(ParsePeer("127.0.0.1:7410").Port, 7410);
    EXPECT_TRUE(ParsePeer("127.0.0.1:7410").HasAddress());
    EXPECT_EQ(ParsePeer("ground-1.local:7410").Host, "ground-1.local");
    EXPECT_FALSE(ParsePeer("ground").HasAddress());
    for (const char *bad : {"", ":7410", "127.0.0.1:", "127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:x",
                            "127.0.0.1:7410x", "127.0.0", "10.0.0.256", "a b", "ground/1"})
    {
        EXPECT_THROW(ParsePeer(bad), TransportError) << bad;
    }
}

#ifdef NDEBUG
TEST(Assertion, IsNotEvaluatedInAReleaseBuild)
{
    int evaluated = 0;
    RABIT_ASSERT(++evaluated < 0);
    EXPECT_EQ(evaluated, 0);
}
#else
TEST(AssertionDeathTest, EndsTheProgramAndNamesTheInvariant)
{
    EXPECT_DEATH(RABIT_ASSERT(1 + 1 == 3), "CommonTest.cpp:.*1 \\+ 1 == 3");
}
#endif

TEST(UseGate, AUserIsTurnedAwayWhileAChangeLasts)
{
    UseGate gate;
    {
        const UseGate::Change change(gate);
        EXPECT_FALSE(UseGate::Use(gate).Allowed());
    }
    EXPECT_TRUE(UseGate::Use(gate).Allowed());
}

TEST(UseGate, AUserIsTurnedAwayWhileAChangeWaitsForAnother)
{
    UseGate gate;
    std::atomic<bool> changed{false};
    std::jthread changer;
    {
        const UseGate::Use first(gate);
        changer = std::jthread(
            [&]
            {
                const UseGate::Change change(gate);
                changed = true;
            });
        while (UseGate::Use(gate).Allowed())
        {
            std::this_thread::yield();
        }
        EXPECT_FALSE(changed);
    }
    changer.join();
    EXPECT_TRUE(changed);
}

TEST(UseGate, AChangeAndItsUsersNeverOverlap)
{
    UseGate gate;
    std::atomic<int> users{0};
    std::atomic<int> overlaps{0};
    {
        std::vector<std::jthread> threads;
        for (int thread = 0; thread < 3; ++thread)
        {
            threads.emplace_back(
                [&]
                {
                    for (int i = 0; i < 500; ++i)
                    {
                        const UseGate::Use use(gate);
                        if (use.Allowed())
                        {
                            ++users;
                            std::this_thread::yield();
                            --users;
                        }
                    }
                });
        }
        for (int i = 0; i < 100; ++i)
        {
            const UseGate::Change change(gate);
            overlaps += users == 0 ? 0 : 1;
        }
    }
    EXPECT_EQ(overlaps, 0);
}

}  // namespace
