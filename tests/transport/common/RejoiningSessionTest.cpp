// The networks that a session joins, and the problems that it tells.
#include "RejoiningFixture.h"

namespace RejoiningTests
{

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST_F(RejoiningSessionTest, OpensWithTheAddressesThatAreThere)
{
    _networks = {Loopback(), Wired, Radio};
    const auto session = Open();
    ASSERT_EQ(_script.Opened.size(), 1u);
    EXPECT_THAT(_script.Opened[0].Interfaces, ElementsAre("10.0.0.1", "10.1.0.1"));
}

// The datagram would go to sockets that are closed.
TEST_F(RejoiningSessionTest, DropsTheDatagramsOfATurnInWhichItJoinsAnew)
{
    const auto session = Open();
    EXPECT_TRUE(TakesTurn(*session));
    const auto change = [&]
    {
        _networks.push_back(Radio);
        Follow(*session);
    };
    EXPECT_FALSE(TakesTurn(*session, change));
    EXPECT_EQ(_script.Opened.size(), 2u);
    EXPECT_TRUE(TakesTurn(*session));
    _script.Refuses = true;
    const auto fail = [&]
    {
        _networks = {Wired};
        _script.Places = {};
        _now += 1h;
        _networks.push_back(Network(4, "radio1", "10.2.0.1"));
        Follow(*session);
    };
    EXPECT_FALSE(TakesTurn(*session, fail)) << "and when it cannot join";
    EXPECT_FALSE(_script.IsOpen);
}

// As without a free descriptor. The kernel reports no change when they can be listed again.
TEST_F(RejoiningSessionTest, LooksAgainForNetworksThatCannotBeListed)
{
    _canList = false;
    const auto session = Open();
    EXPECT_THAT(_script.Opened, IsEmpty());
    ASSERT_EQ(session->NetworkProblems().size(), 1u);
    EXPECT_THAT(session->NetworkProblems()[0].Text, HasSubstr("cannot be listed"));
    EXPECT_EQ(session->Look(), 1000ms);
    _canList = true;
    Follow(*session);
    ASSERT_EQ(_script.Opened.size(), 1u);
    EXPECT_THAT(session->NetworkProblems(), IsEmpty());
    _canList = false;
    EXPECT_EQ(session->Look(), 1000ms) << "it goes on with its networks";
    EXPECT_TRUE(_script.IsOpen);
}

TEST_F(RejoiningSessionTest, LeavesTheChoiceToABackendThatFindsNetworksUnlessTheyAreNamed)
{
    _script.FindsNetworks = true;
    {
        const auto session = Open();
        EXPECT_THAT(_script.Opened.back().Interfaces, IsEmpty());
    }
    _settings.Interfaces = {"eth0"};
    const auto session = Open();
    EXPECT_THAT(_script.Opened.back().Interfaces, ElementsAre("10.0.0.1"));
}

TEST_F(RejoiningSessionTest, DoesNotWaitForInterfacesThatTheConfigurationFileReplaces)
{
    _script.OwnNetworks = true;
    _settings.Interfaces = {"radio99"};
    const auto session = Open();
    ASSERT_EQ(_script.Opened.size(), 1u);
    EXPECT_THAT(_script.Opened[0].Interfaces, IsEmpty());
    EXPECT_THAT(Entries(*session), IsEmpty());
}

TEST_F(RejoiningSessionTest, WaitsForANamedInterfaceAndSaysSo)
{
    _settings.Interfaces = {"radio0"};
    const auto session = Open();
    const auto writer = session->CreateWriter(_pose, {}, {});
    const auto reader = session->CreateReader(_pose, {}, {}, {});
    EXPECT_THAT(_script.Opened, IsEmpty());
    EXPECT_THAT(Entries(*session), ElementsAre("radio0"));
    EXPECT_EQ(writer->Write(Sample(), 1), WriteResult::TimedOut);
    EXPECT_EQ(writer->Dispose(Sample(), 1), WriteResult::TimedOut);
    EXPECT_EQ(writer->MatchedReaders(), 0);
    EXPECT_EQ(reader->MatchedWriters(), 0);
    EXPECT_EQ(session->Counters().WriteTimeouts, 2u);
    EXPECT_THAT(_log, Not(Contains(HasSubstr("timed out")))) << "the missing interface is the reason";

    _networks = {Wired, Radio};
    Follow(*session);
    ASSERT_EQ(_script.Opened.size(), 1u);
    EXPECT_THAT(_script.Opened[0].Interfaces, ElementsAre("10.1.0.1"));
    EXPECT_THAT(Entries(*session), IsEmpty());
    EXPECT_EQ(writer->Write(Sample(), 1), WriteResult::Ok);
    EXPECT_EQ(writer->MatchedReaders(), 3);
    EXPECT_EQ(reader->MatchedWriters(), 4);
}

TEST_F(RejoiningSessionTest, SaysWhatIsMissingNow)
{
    _settings.Interfaces = {"eth0", "radio0"};
    const auto session = Open();
    _networks = {Wired, WithoutCarrier(Radio)};
    session->Look();
    const auto problems = session->NetworkProblems();
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].Text, "the interface radio0 has no carrier: waiting for it");
}

TEST_F(RejoiningSessionTest, RefusesABadConfigurationFileAlsoWhileItWaits)
{
    _settings.Interfaces = {"radio0"};
    _script.RefusedConfig = "not XML";
    EXPECT_THROW(Open(), TransportError);
}

TEST_F(RejoiningSessionTest, ThrowsIfTheBackendDoesNotOpenAtFirst)
{
    _script.Refuses = true;
    EXPECT_THROW(Open(), TransportError);
}

TEST_F(RejoiningSessionTest, TriesAgainAfterAFailureAndSaysSo)
{
    const auto session = Open();
    _script.Refuses = true;
    _networks = {Wired, Radio};
    for (int i = 0; i < 4; ++i)
    {
        _now += session->Look().value_or(0ms);
    }
    EXPECT_FALSE(_script.IsOpen);
    const auto problems = session->NetworkProblems();
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].Text, "cannot join the network: no free port");
    EXPECT_EQ(problems[0].Setting, "domain");
    _script.Refuses = false;
    Follow(*session);
    EXPECT_TRUE(_script.IsOpen);
    EXPECT_THAT(Entries(*session), IsEmpty());
}

TEST_F(RejoiningSessionTest, DoesNotTryAgainAtOnceAfterAFailure)
{
    const auto session = Open();
    int attempts = 0;
    _script.InOpen = [&] { ++attempts; };
    _script.Refuses = true;
    _networks = {Wired, Radio};
    for (int i = 0; i < 100 && attempts == 0; ++i)
    {
        _now += session->Look().value_or(0ms);
    }
    EXPECT_EQ(session->Look(), 1000ms);
    EXPECT_EQ(attempts, 1);
}

TEST_F(RejoiningSessionTest, APeerIsLookedUpAgainUntilItHasAnAddress)
{
    _settings.Peers = {"ground:7410", "10.0.0.7", "uav2"};
    _names["uav2"] = "10.0.0.3";
    const auto session = Open();
    EXPECT_THAT(_script.Opened[0].Peers, ElementsAre("10.0.0.7", "10.0.0.3"));
    EXPECT_THAT(Entries(*session), ElementsAre("ground:7410"));
    Follow(*session);
    EXPECT_EQ(_script.Opened.size(), 1u);
    EXPECT_EQ(session->Look(), 500ms);
    _names["ground"] = "10.0.0.9";
    Follow(*session);
    EXPECT_EQ(session->Look(), std::nullopt);
    ASSERT_EQ(_script.Opened.size(), 2u);
    EXPECT_THAT(_script.Opened[1].Peers, ElementsAre("10.0.0.9:7410", "10.0.0.7", "10.0.0.3"));
    EXPECT_THAT(Entries(*session), IsEmpty());
}

TEST_F(RejoiningSessionTest, ANetworkWhoseAddressAnotherHostHasIsLeftOutIfThatMisleadsTheBackend)
{
    _networks = {Wired, Radio};
    _script.Places = {{"10.0.0.1", "10.1.0.2"}};
    {
        const auto session = Open();
        Follow(*session);
        EXPECT_EQ(_script.Opened.size(), 1u);
    }
    _script.Duplicates = true;
    const auto session = Open();
    _script.Opened.clear();
    Follow(*session);
    ASSERT_EQ(_script.Opened.size(), 1u);
    EXPECT_THAT(_script.Opened[0].Interfaces, ElementsAre("10.1.0.1"));
    EXPECT_THAT(Entries(*session), ElementsAre("eth0"));
}

}  // namespace RejoiningTests
