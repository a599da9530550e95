#include "report/Diagnosis.h"

#include <gtest/gtest.h>

#include "BeatSamples.h"
#include "presence/QueueAcceptance.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;

// A beat of second 1 with this announcement, or with none.
HeardBeat BeatOf(const std::string &node, const Gateway::Announcement *offers)
{
    HeardBeat heard;
    heard.Node = node;
    heard.Incarnation = 5;
    heard.Beat = BeatAt(1s);
    heard.Arrival = 1s;
    if (offers != nullptr)
    {
        Announce(heard.Beat, *offers);
    }
    return heard;
}

class DiagnosisTest : public ::testing::Test
{
protected:
    DiagnosisTest()
    {
        rule.Message = "Pose";
        rule.Type = "Uav::Pose";
        rule.From = {"uav*"};
        wanted.Rule = &rule;
        wanted.Definition = 11;
        wanted.ReceptionFrom = [this](const std::string &) { return reception; };
    }

    void Offer(const std::string &message, const std::string &type, const std::string &qos,
               std::uint64_t definition)
    {
        Gateway::PublishedMessage published;
        published.message = message;
        published.type = type;
        published.qos = qos;
        published.definition = definition;
        offers.publishes.push_back(published);
    }

    void Accept(const std::string &queue, const std::string &type, std::uint64_t definition)
    {
        Gateway::QueueType accepted;
        accepted.type = type;
        accepted.definition = definition;
        Gateway::AcceptedQueue entry;
        entry.queue = queue;
        entry.from = {"gr*"};
        entry.types.push_back(accepted);
        offers.accepts.push_back(entry);
    }

    // uav1 is live from second 1 on.
    void Hear(bool withOffers = true) { peers.OnBeat(BeatOf("uav1", withOffers ? &offers : nullptr)); }

    // Returns "node: reason" of the only problem, or else the number of problems.
    std::string Problem(Ns now) const
    {
        const auto problems = Diagnosis::OfSubscription(wanted, peers, now, now);
        return problems.size() == 1 ? problems[0].node + ": " + problems[0].reason
                                    : std::to_string(problems.size()) + " problems";
    }

    SubscribeRule rule;
    Diagnosis::Wanted wanted;
    Reception reception;
    Gateway::Announcement offers;
    PeerTable peers{"ground", 1};
};

TEST_F(DiagnosisTest, NoNodeOfThatName)
{
    EXPECT_EQ(Problem(1400ms), "0 problems");
    EXPECT_EQ(Problem(1500ms), ": no node named `uav*` has been heard");
}

TEST_F(DiagnosisTest, NoSuchMessageThere)
{
    Offer("MissionState", "Uav::MissionState", "state", 12);
    Hear();
    EXPECT_EQ(Problem(1s), "uav1: uav1 does not publish `Pose`; it publishes `MissionState`");
}

TEST_F(DiagnosisTest, NothingPublishedThere)
{
    Hear();
    EXPECT_EQ(Problem(1s), "uav1: uav1 does not publish `Pose`; it publishes nothing");
}

TEST_F(DiagnosisTest, FromEverybodyNobodyNeedPublishWhatSomebodyDoes)
{
    const Gateway::Announcement camera;
    peers.OnBeat(BeatOf("uav1.vision", &camera));
    Offer("Pose", "Uav::Pose", "telemetry", 11);
    Hear();
    reception.PostedOf = 5;
    EXPECT_EQ(Problem(1s), "uav1.vision: uav1.vision does not publish `Pose`; it publishes nothing");
    rule.From = {"*"};
    EXPECT_EQ(Problem(1s), "0 problems");
}

TEST_F(DiagnosisTest, FromEverybodyNobodyPublishesIt)
{
    rule.From = {"*"};
    Hear();
    EXPECT_EQ(Problem(1s), "uav1: uav1 does not publish `Pose`; it publishes nothing");
}

TEST_F(DiagnosisTest, OtherType)
{
    Offer("Pose", "Uav::Goto", "telemetry", 11);
    Hear();
    EXPECT_FALSE(Diagnosis::OfSubscription(wanted, peers, 1s, 1s).at(0).certain);
    EXPECT_EQ(Problem(1s), "uav1: uav1 publishes `Pose` as `Uav::Goto`, this node wants `Uav::Pose`");
}

TEST_F(DiagnosisTest, OtherDefinitionOfTheSameTypeName)
{
    Offer("Pose", "Uav::Pose", "telemetry", 99);
    Hear();
    EXPECT_EQ(Problem(1s), "uav1: uav1 was built with another definition of `Uav::Pose`");
    EXPECT_TRUE(Diagnosis::OfSubscription(wanted, peers, 1s, 1s).at(0).certain);
}

TEST_F(DiagnosisTest, OtherQos)
{
    rule.Qos = QosProfile::State;
    Offer("Pose", "Uav::Pose", "telemetry", 11);
    Hear();
    EXPECT_EQ(Problem(1s), "uav1: uav1 publishes `Pose` with qos telemetry, this node wants qos state");
}

TEST_F(DiagnosisTest, AStateFitsATelemetrySubscription)
{
    rule.Qos = QosProfile::Telemetry;
    Offer("Pose", "Uav::Pose", "state", 11);
    Hear();
    EXPECT_EQ(Problem(1s), "0 problems");
}

TEST_F(DiagnosisTest, NotAnnounced)
{
    Hear(false);
    EXPECT_EQ(Problem(2s), "0 problems");
    EXPECT_EQ(Problem(2500ms), "uav1: no announcement of uav1 has arrived yet");
}

TEST_F(DiagnosisTest, NotDiscovered)
{
    Offer("Pose", "Uav::Pose", "telemetry", 11);
    Hear();
    EXPECT_EQ(Problem(2s), "0 problems");
    EXPECT_EQ(Problem(2500ms), "uav1: uav1 announces `Pose`, but its writer has not been discovered");
}

TEST_F(DiagnosisTest, NothingPostedYet)
{
    Offer("Pose", "Uav::Pose", "telemetry", 11);
    Hear();
    reception.MatchedWriters = 1;
    EXPECT_EQ(
        Problem(2500ms),
        "uav1: nothing has been received: uav1 has posted no `Pose` yet, or its samples do not get through");
}

TEST_F(DiagnosisTest, NothingIsWrongWhenDataComes)
{
    Offer("Pose", "Uav::Pose", "telemetry", 11);
    Hear();
    reception.MatchedWriters = 1;
    reception.PostedOf = 5;
    EXPECT_EQ(Problem(60s), "0 problems");
}

TEST_F(DiagnosisTest, DataOfAFormerIncarnationDoesNotHideThatNothingComes)
{
    Offer("Pose", "Uav::Pose", "telemetry", 11);
    Hear();
    reception.MatchedWriters = 1;
    reception.PostedOf = 4;
    EXPECT_EQ(Problem(2s), "0 problems") << "it has just come";
    EXPECT_EQ(
        Problem(2500ms),
        "uav1: nothing has been received: uav1 has posted no `Pose` yet, or its samples do not get through");
}

TEST_F(DiagnosisTest, ALostNodeIsNoProblemOfTheSubscription)
{
    Offer("Pose", "Uav::Pose", "telemetry", 99);
    Hear();
    peers.Advance(60s);
    EXPECT_EQ(Problem(60s), "0 problems");
}

// Returns "subject: reason" of each problem of LOST nodes, in lines.
std::string LostNodes(const std::deque<SubscribeRule> &subscribe, const PeerTable &peers,
                      const std::vector<SendRule> &send = {}, std::uint32_t waiting = 0)
{
    Gateway::Fleet fleet;
    Gateway::NodeStatus &row = fleet.nodes.emplace_back();
    row.node = "uav1";
    row.outbox = waiting;
    std::string lines;
    for (const Gateway::Problem &problem : Diagnosis::OfLostNodes(subscribe, send, fleet, peers))
    {
        EXPECT_EQ(problem.node, "uav1");
        lines += problem.subject + ": " + problem.reason + "\n";
    }
    return lines;
}

TEST_F(DiagnosisTest, ALostNodeIsAProblemOfANodeThatWantsIt)
{
    Offer("Pose", "Uav::Pose", "telemetry", 11);
    Hear();
    SubscribeRule state = rule;
    state.Message = "MissionState";
    SubscribeRule other = rule;
    other.From = {"uav2"};
    const std::deque<SubscribeRule> rules{rule, state, other};
    const std::string lost = "node uav1: it is LOST: no beat within its limit of 3.5 s";
    EXPECT_EQ(LostNodes(rules, peers), "");
    peers.Advance(60s);
    EXPECT_EQ(LostNodes(rules, peers), lost + "; this node subscribes to its `Pose`, `MissionState`\n");
    EXPECT_EQ(LostNodes({other}, peers), "");
    EXPECT_EQ(LostNodes({other}, peers, {{.To = "*"}, {.To = "uav1"}}), lost + "; this node sends to it\n");
    EXPECT_EQ(LostNodes({other}, peers, {}, 1), lost + "; messages for it wait\n");
}

TEST_F(DiagnosisTest, ALostNodeThatHadNoSuchMessageIsNotMissedByOneThatTakesItFromEverybody)
{
    rule.From = {"*"};
    rule.Message = "Health";
    Offer("Pose", "Uav::Pose", "telemetry", 11);
    Hear();
    Gateway::Announcement health;
    health.publishes.emplace_back().message = "Health";
    peers.OnBeat(BeatOf("uav2", &health));
    peers.Advance(3s);
    peers.OnLeft("uav2", 5);
    peers.Advance(60s);
    EXPECT_EQ(LostNodes({rule}, peers), "");
}

TEST_F(DiagnosisTest, ANodeThatSaidGoodbyeIsAProblemOnlyIfItIsWantedByName)
{
    Hear();
    peers.OnLeft("uav1", 5);
    EXPECT_EQ(LostNodes({rule}, peers), "");
    rule.From = {"uav2", "uav1"};
    EXPECT_EQ(LostNodes({rule}, peers), "node uav1: it is LOST: left; this node subscribes to its `Pose`\n");
}

TEST_F(DiagnosisTest, WhyAQueueDoesNotTakeAMessage)
{
    Accept("MissionControl", "Uav::Goto", 21);
    Hear();
    const PeerTable::Peer &uav1 = *peers.Find("uav1");
    const auto reason = [&uav1](const char *queue, const char *type, std::uint64_t definition)
    { return WhyNotAccepted(AcceptanceOf(uav1, queue, type, definition, "ground"), uav1, queue, type); };

    EXPECT_EQ(reason("MissionControl", "Uav::Goto", 21), "");
    EXPECT_EQ(reason("Missions", "Uav::Goto", 21),
              "uav1 accepts no queue `Missions`; it accepts `MissionControl`");
    EXPECT_EQ(reason("MissionControl", "Uav::Pose", 21),
              "queue `MissionControl` of uav1 does not accept `Uav::Pose`; it accepts `Uav::Goto`");
    EXPECT_EQ(reason("MissionControl", "Uav::Goto", 22),
              "uav1 was built with another definition of `Uav::Goto`");
    const QueueAcceptance elsewhere = AcceptanceOf(uav1, "MissionControl", "Uav::Goto", 21, "uav2");
    EXPECT_EQ(WhyNotAccepted(elsewhere, uav1, "MissionControl", "Uav::Goto"),
              "queue `MissionControl` of uav1 accepts no messages of this node, but of `gr*`");
}

}  // namespace
}  // namespace Rabit
