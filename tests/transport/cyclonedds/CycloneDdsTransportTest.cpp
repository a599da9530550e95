// The Cyclone DDS backend and the settings that only a real network has.
#include <rabit/cyclonedds/CycloneDdsTransport.h>

#include <memory>
#include <string>
#include <vector>

#include "../conformance/NetworkSettings.h"
#include "../conformance/ProcessHarness.h"
#include "../conformance/Recorder.h"
#include "../conformance/TestSample.h"

namespace Rabit::Conformance
{

namespace
{

using Kind = PeerEvent::Kind;

std::unique_ptr<TransportHarness> MakeHarness()
{
    return std::make_unique<ProcessHarness>(std::make_unique<CycloneDdsTransport>());
}

// A configuration whose DDS Security is complete, in an element of that name: the vendor itself accepts it.
// `space`: behind the name, where the section begins.
std::string WithSecurity(const std::string &element, const std::string &space = "")
{
    return "<CycloneDDS><Domain Id=\"any\"><" + element + space +
           "><Authentication><Library/><IdentityCertificate>data:,x</IdentityCertificate>"
           "<IdentityCA>data:,x</IdentityCA><PrivateKey>data:,x</PrivateKey></Authentication>"
           "<AccessControl><Library/><Governance>data:,x</Governance>"
           "<PermissionsCA>data:,x</PermissionsCA><Permissions>data:,x</Permissions></AccessControl>"
           "<Cryptographic><Library/></Cryptographic></" +
           element + "></Domain></CycloneDDS>";
}

class CycloneDdsTransportTest : public testing::Test, protected NetworkFixture
{
protected:
    CycloneDdsTransportTest() : NetworkFixture(MakeHarness()) {}
};

TEST_F(CycloneDdsTransportTest, ABrokenConfigurationFileIsRefusedWithTheVendorsReason)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile("<CycloneDDS><Domain Id=\"any\"><Generl/></Domain></CycloneDDS>");
    ExpectRefusal(settings, "Generl", "backend_config");
}

TEST_F(CycloneDdsTransportTest, AConfigurationWithDdsSecurityIsRefused)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile(WithSecurity("Security"));
    ExpectRefusal(settings, "rabit keys", "backend_config");
}

TEST_F(CycloneDdsTransportTest, TheVendorsOtherSpellingsOfDdsSecurityAreRefused)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile(WithSecurity("security", " "));
    ExpectRefusal(settings, "rabit keys", "backend_config");
}

TEST_F(CycloneDdsTransportTest, ARefusedSessionLeavesTheDomainFree)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile("<CycloneDDS><Domain Id=\"any\"><Generl/></Domain></CycloneDDS>");
    ExpectRefusal(settings, "Generl", "backend_config");
    ExpectRefusal(settings, "Generl", "backend_config");
    ExpectDelivery(Settings("uav1"), Settings("ground"));
}

// A file that forbids all multicast discovery shows that it is applied: the session does not find one that
// announces itself by multicast, and is not found. One that comes later and lists its peers finds both.
TEST_F(CycloneDdsTransportTest, AConfigurationFileIsLaidOverTheSettings)
{
    auto deaf = Settings("uav1");
    deaf.BackendConfig = TemporaryFile(
        "<CycloneDDS><Domain Id=\"any\"><General><AllowMulticast>false</AllowMulticast>"
        "</General></Domain></CycloneDDS>");
    PeerRecorder atDeaf;
    PeerRecorder atOther;
    const auto one = Backend().Open(deaf, atDeaf.Handler());
    const auto other = Backend().Open(Settings("ground"), atOther.Handler());
    auto listing = Settings("uav3");
    listing.Peers = {"127.0.0.1"};
    const auto third = Backend().Open(listing, {});
    ASSERT_TRUE(Net().Until([&] { return atOther.Count(Kind::Appeared, "uav3", 1) == 1; }));
    ASSERT_TRUE(Net().Until([&] { return atDeaf.Count(Kind::Appeared, "uav3", 1) == 1; }));
    EXPECT_EQ(atDeaf.Count(Kind::Appeared, "ground", 1), 0);
    EXPECT_EQ(atOther.Count(Kind::Appeared, "uav1", 1), 0);
}

TEST_F(CycloneDdsTransportTest, AConfigurationFileMayNameTheDomain)
{
    auto settings = Settings("uav1");
    settings.BackendConfig = TemporaryFile("<CycloneDDS><Domain Id=\"" + std::to_string(settings.Domain) +
                                           "\"><Generl/></Domain></CycloneDDS>");
    ExpectRefusal(settings, "Generl", "backend_config");
}

TEST_F(CycloneDdsTransportTest, SessionsOfOneProcessInSeveralDomainsDoNotHearEachOther)
{
    const DomainLease elsewhere;
    PeerRecorder here;
    auto settings = Settings("ground");
    const auto ground = Backend().Open(settings, here.Handler());
    settings.Node = "stranger";
    settings.Domain = elsewhere.Domain();
    const auto stranger = Backend().Open(settings, {});
    // One that is opened later is heard behind the stranger's announcement.
    const auto uav = Backend().Open(Settings("uav1"), {});
    ASSERT_TRUE(Net().Until([&] { return here.Count(Kind::Appeared, "uav1", 1) == 1; }));
    EXPECT_EQ(here.Count(Kind::Appeared, "stranger", 1), 0);
}

TEST_F(CycloneDdsTransportTest, TwentySessionsOfOneHostFindEachOther)
{
    PeerRecorder peers;
    std::vector<std::unique_ptr<TransportSession>> sessions;
    sessions.push_back(Backend().Open(Settings("ground"), peers.Handler()));
    for (int i = 1; i <= 20; ++i)
    {
        sessions.push_back(Backend().Open(Settings("uav" + std::to_string(i)), {}));
    }
    for (int i = 1; i <= 20; ++i)
    {
        EXPECT_TRUE(
            Net().Until([&] { return peers.Count(Kind::Appeared, "uav" + std::to_string(i), 1) == 1; }))
            << i;
    }
}

// The writing side takes the topic for one without a key. It sends no key hash, and a body too short to
// have a key.
TEST_F(CycloneDdsTransportTest, ASampleWithoutAReadableKeyIsCountedWhereItArrives)
{
    TopicDescription keyed = KeyedTopic();
    TopicDescription liar = keyed;
    liar.KeyOf = [](SampleBytes, KeyHash &) { return true; };
    keyed.KeyOf = [](SampleBytes, KeyHash &) { return false; };
    auto withoutHash = Settings("uav1");
    withoutHash.BackendConfig = TemporaryFile(
        "<CycloneDDS><Domain Id=\"any\"><Internal><GenerateKeyhash>false"
        "</GenerateKeyhash></Internal></Domain></CycloneDDS>");
    const auto writing = Backend().Open(withoutHash, {});
    const auto reading = Backend().Open(Settings("ground"), {});
    SampleRecorder recorder;
    const auto writer = writing->CreateWriter(liar, State(), {});
    const auto reader = reading->CreateReader(keyed, State(), {}, recorder.Handler());
    ASSERT_EQ(WriteOnceTaken(*writer, RawSample({1, 2, 3}), 1), WriteResult::Ok);
    EXPECT_TRUE(Net().Until([&] { return reading->Counters().MalformedSamples > 0; }));
    EXPECT_EQ(recorder.Count(), 0u);
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(CycloneDds, NetworkSettings,
                         testing::Values(HarnessMaker{"cyclonedds", &MakeHarness}));

}  // namespace Rabit::Conformance
