// The table of sessions that may speak on a path, and claims as bytes.
#include "envelope/SessionTable.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>

#include "SealNodes.h"

namespace
{

using namespace SealNodes;
using std::chrono::seconds;

class SealSessions : public testing::Test
{
protected:
    // A verified claim of a session of that node.
    SessionTable::Facts Facts(std::uint8_t node, std::uint8_t opening = 0, bool proves = false,
                              int prefix = -1)
    {
        const std::string name = "uav" + std::to_string(int{node});
        const Bytes bytes = Signs.Certify(name, node, node);
        const Certificate content = *ReadCertificate(bytes);
        auto certificate = std::make_shared<KnownCertificate>(KnownCertificate{
            .Hash = Sha256(bytes), .Content = content, .Key = *VerifyingKey::Of(content.Signing)});
        return {.Sender = {.Session = SessionOf(node, opening), .Certificate = certificate->Hash},
                .Certificate = certificate,
                .Headers = {HeaderOf(prefix < 0 ? node : static_cast<std::uint8_t>(prefix))},
                .LiveAt = proves ? std::optional(Start) : std::nullopt};
    }
    ClaimVerdict Verdict(const SessionTable::Facts &facts, TimePoint now = Start)
    {
        return Table.Take(facts, now).Verdict;
    }
    Session *Find(std::uint8_t node, std::uint8_t opening = 0)
    {
        return Table.Find(TagOf(Facts(node, opening).Sender));
    }

    Authority Signs;
    End Own{.Session = SessionOf(200, 0), .Certificate = Sha256(Signs.Certify("ground", 200, 200))};
    std::vector<RtpsHeader> OwnHeaders{HeaderOf(200)};
    SessionTable Table{Own, "ground", OwnHeaders};
};

TEST_F(SealSessions, AreAddedKnownAndProven)
{
    EXPECT_EQ(Find(1), nullptr);
    EXPECT_EQ(Verdict(Facts(1)), ClaimVerdict::Added);
    EXPECT_FALSE(Find(1)->IsProven());
    EXPECT_EQ(Verdict(Facts(1)), ClaimVerdict::Known);
    EXPECT_EQ(Verdict(Facts(1, 0, true)), ClaimVerdict::Proven);
    EXPECT_TRUE(Find(1)->IsFresh(Start));
    EXPECT_EQ(Table.Size(), 1u);
}

TEST_F(SealSessions, KeepTheHeadersOfTheFirstClaim)
{
    Verdict(Facts(1));
    SessionTable::Facts other = Facts(1);
    other.Headers.push_back(HeaderOf(1, 0x62));
    EXPECT_EQ(Verdict(other), ClaimVerdict::OtherHeaders);
    EXPECT_EQ(Find(1)->Headers().size(), 1u);
}

TEST_F(SealSessions, OfOneCertificateMayHaveOnePrefix)
{
    EXPECT_EQ(Verdict(Facts(1, 0, true)), ClaimVerdict::Proven);
    EXPECT_EQ(Verdict(Facts(1, 1, true)), ClaimVerdict::Proven);
}

TEST_F(SealSessions, OfTwoCertificatesMayNot)
{
    Verdict(Facts(1, 0, true));
    for (const bool proves : {false, true})
    {
        const SessionTable::Result refused = Table.Take(Facts(2, 0, proves, 1), Start);
        EXPECT_EQ(refused.Verdict, ClaimVerdict::PrefixTaken);
        EXPECT_EQ(refused.Holder, "uav1");
        EXPECT_EQ(refused.Of, nullptr);
    }
    EXPECT_EQ(Table.Size(), 1u);
}

TEST_F(SealSessions, ANodeKeepsItsPrefixHoweverLongItIsSilent)
{
    Verdict(Facts(1, 0, true));
    SessionTable::Facts other = Facts(2, 0, true, 1);
    // Vendors remember writers for hours: TransportSettings::Memory.
    const TimePoint later = Start + std::chrono::hours(24);
    other.LiveAt = later;
    const SessionTable::Result refused = Table.Take(other, later);
    EXPECT_EQ(refused.Verdict, ClaimVerdict::PrefixTaken);
    EXPECT_EQ(refused.Holder, "uav1");
    SessionTable::Facts back = Facts(1, 0, true);
    back.LiveAt = later;
    EXPECT_EQ(Verdict(back, later), ClaimVerdict::Proven);
}

TEST_F(SealSessions, AMereClaimOfAPrefixHoldsNothing)
{
    Verdict(Facts(2, 0, false, 1));
    EXPECT_EQ(Verdict(Facts(1, 0, true)), ClaimVerdict::Proven);
    // The first claim cannot be proven any more.
    EXPECT_EQ(Verdict(Facts(2, 0, true, 1)), ClaimVerdict::PrefixTaken);
    EXPECT_FALSE(Find(2)->IsProven());
}

TEST_F(SealSessions, NobodyGetsTheOwnPrefix)
{
    const SessionTable::Result refused = Table.Take(Facts(1, 0, true, 200), Start);
    EXPECT_EQ(refused.Verdict, ClaimVerdict::PrefixTaken);
    EXPECT_EQ(refused.Holder, "ground");
    // Another session of this node may have it: another path.
    SessionTable::Facts own = Facts(200, 1, true);
    own.Sender.Certificate = Own.Certificate;
    EXPECT_EQ(Verdict(own), ClaimVerdict::Proven);
}

TEST_F(SealSessions, RecordedClaimsDisplaceEachOtherAlone)
{
    Verdict(Facts(1, 0, true));
    Verdict(Facts(2, 0, false));
    for (std::uint8_t opening = 1; opening < 100; ++opening)
    {
        EXPECT_EQ(Verdict(Facts(1, opening), Start + seconds(opening)), ClaimVerdict::Added);
    }
    EXPECT_EQ(Table.Size(), 2 + SessionTable::MostUnprovenOfOne);
    EXPECT_NE(Find(1), nullptr);
    EXPECT_NE(Find(2), nullptr);
    EXPECT_NE(Find(1, 99), nullptr);
    EXPECT_EQ(Find(1, 99 - SessionTable::MostUnprovenOfOne), nullptr);
}

TEST_F(SealSessions, ThatWereDisplacedComeBackWithHigherNumbersAlone)
{
    Verdict(Facts(1));
    const End displaced = Find(1)->Sender();
    Find(1)->Window().Mark(7);
    for (std::uint8_t opening = 1; opening <= SessionTable::MostUnprovenOfOne; ++opening)
    {
        Verdict(Facts(1, opening), Start + seconds(opening));
    }
    ASSERT_EQ(Find(1), nullptr);
    EXPECT_TRUE(Table.WasTaken(displaced, 7));
    EXPECT_FALSE(Table.WasTaken(displaced, 8));
    // Its former datagrams do not open once it is back.
    Verdict(Facts(1), Start + seconds(9));
    EXPECT_EQ(Find(1)->Window().Look(7), ReplayWindow::Verdict::TooOld);
    EXPECT_EQ(Find(1)->Window().Look(8), ReplayWindow::Verdict::New);
}

TEST_F(SealSessions, OfOneCertificateThatAreProvenAreBounded)
{
    for (std::uint8_t opening = 0; opening < 50; ++opening)
    {
        // Some become proven later.
        if (opening % 2 == 0)
        {
            Verdict(Facts(1, opening));
        }
        SessionTable::Facts proven = Facts(1, opening, true);
        proven.LiveAt = Start + seconds(opening);
        EXPECT_EQ(Verdict(proven, Start + seconds(opening)), ClaimVerdict::Proven);
    }
    EXPECT_EQ(Table.Size(), SessionTable::MostProvenOfOne);
    EXPECT_NE(Find(1, 49), nullptr);
    EXPECT_EQ(Find(1, 41), nullptr);
}

TEST_F(SealSessions, AreBoundedInAll)
{
    // One certificate each: the hash alone makes another, for the table.
    SessionTable::Facts facts = Facts(1);
    const auto another = [&facts](std::size_t number, bool proves)
    {
        SessionTable::Facts other = facts;
        other.Sender.Certificate[0] = static_cast<std::uint8_t>(number);
        other.Sender.Certificate[1] = static_cast<std::uint8_t>(number >> 8);
        other.Headers[0][Prefix] = static_cast<std::uint8_t>(number);
        other.Headers[0][Prefix + 1] = static_cast<std::uint8_t>(number >> 8);
        other.LiveAt = proves ? std::optional(Start) : std::nullopt;
        return other;
    };
    for (std::size_t i = 0; i < SessionTable::Most - 1; ++i)
    {
        ASSERT_EQ(Verdict(another(i, true)), ClaimVerdict::Proven);
    }
    EXPECT_EQ(Verdict(another(5000, false)), ClaimVerdict::Added);
    // The one that is not proven makes room.
    EXPECT_EQ(Verdict(another(5001, true)), ClaimVerdict::Proven);
    EXPECT_EQ(Verdict(another(5002, true)), ClaimVerdict::TooMany);
    EXPECT_EQ(Verdict(another(5003, false)), ClaimVerdict::TooMany);
    EXPECT_EQ(Table.Size(), SessionTable::Most);
    // One that was silent for an hour makes room for one that is live, not for a mere claim.
    const TimePoint later = Start + SessionTable::HoldsFor + seconds(1);
    EXPECT_EQ(Verdict(another(5004, false), later), ClaimVerdict::TooMany);
    EXPECT_EQ(Verdict(another(5005, true), later), ClaimVerdict::Proven);
    EXPECT_EQ(Table.Size(), SessionTable::Most);
}

TEST_F(SealSessions, AProofDisplacesAMereClaimOfItsTag)
{
    // Two ends whose hashes begin alike, found by trying.
    End first{.Session = {}, .Certificate = Facts(1).Sender.Certificate};
    End second{.Session = {}, .Certificate = Facts(2).Sender.Certificate};
    std::set<std::pair<SessionTag, std::uint32_t>> tags;
    const auto put = [](End &end, std::uint32_t number)
    {
        for (std::size_t i = 0; i < 4; ++i)
        {
            end.Session[i] = static_cast<std::uint8_t>(number >> 8 * i);
        }
    };
    for (std::uint32_t i = 0; i < 70'000; ++i)
    {
        put(first, i);
        tags.insert({TagOf(first), i});
    }
    bool together = false;
    for (std::uint32_t i = 0; i < 400'000 && !together; ++i)
    {
        put(second, i);
        const SessionTag tag = TagOf(second);
        const auto at = tags.lower_bound({tag, 0});
        if (at != tags.end() && at->first == tag)
        {
            put(first, at->second);
            together = true;
        }
    }
    ASSERT_TRUE(together);
    SessionTable::Facts of1 = Facts(1);
    of1.Sender = first;
    SessionTable::Facts of2 = Facts(2);
    of2.Sender = second;
    EXPECT_EQ(Verdict(of1), ClaimVerdict::Added);
    const SessionTable::Result refused = Table.Take(of2, Start);
    EXPECT_EQ(refused.Verdict, ClaimVerdict::TagTaken);
    EXPECT_EQ(refused.Holder, "uav1");
    of2.LiveAt = Start;
    EXPECT_EQ(Verdict(of2), ClaimVerdict::Proven);
    of1.LiveAt = Start;
    EXPECT_EQ(Verdict(of1), ClaimVerdict::TagTaken);
    EXPECT_EQ(Table.Size(), 1u);
}

TEST_F(SealSessions, DeriveKeysOfWhatTheySendOnceForEachEpoch)
{
    Verdict(Facts(1));
    Session &session = *Find(1);
    const AgreementKey own = *AgreementKey::Of(SeedOf(4, 200));
    std::set<SecretKey::Content> keys;
    for (Epoch epoch = 1; epoch <= EpochSecrets::Most; ++epoch)
    {
        keys.insert(session.GroupKeyOf(epoch, FirstSecret)->Bytes());
        keys.insert(session.KeyFrom(epoch, FirstSecret, own, Own)->Bytes());
        keys.insert(session.ReceiverIn(epoch, FirstSecret, own, Own)->Key.Bytes());
    }
    EXPECT_EQ(keys.size(), 3 * EpochSecrets::Most);
    // They are kept: another secret changes nothing.
    for (Epoch epoch = 1; epoch <= EpochSecrets::Most; ++epoch)
    {
        EXPECT_TRUE(keys.contains(session.GroupKeyOf(epoch, SecondSecret)->Bytes()));
    }
}

TEST(SealClaims, AreTheSameAfterWritingAndReading)
{
    const Bytes certificate = Authority().Certify("uav1", 1, 1);
    const Claim claim{.Challenge = {1, 2, 3},
                      .Headers = {HeaderOf(1), HeaderOf(2)},
                      .Answers = {{4, 5}, {6, 7}, {8, 9}},
                      .Certificate = certificate};
    const Bytes bytes = WriteClaim(claim);
    const auto read = ReadClaim(bytes);
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->Challenge, claim.Challenge);
    EXPECT_EQ(read->Headers, claim.Headers);
    EXPECT_EQ(read->Answers, claim.Answers);
    EXPECT_EQ(BytesOf(read->Certificate), certificate);
}

TEST(SealClaims, AreRefusedCutOrWithOneByteMore)
{
    const Bytes certificate(40, 1);
    Bytes bytes = WriteClaim({.Headers = {HeaderOf(1)}, .Answers = {{4, 5}}, .Certificate = certificate});
    for (std::size_t size = 0; size < bytes.size(); ++size)
    {
        EXPECT_FALSE(ReadClaim(std::span(bytes).first(size)).has_value()) << size;
    }
    bytes.push_back(0);
    EXPECT_FALSE(ReadClaim(bytes).has_value());
}

TEST(SealClaims, AreRefusedOutsideOfTheirLimits)
{
    const Bytes good = WriteClaim({.Headers = {HeaderOf(1)}});
    const auto with = [&good](std::size_t at, std::uint8_t value, std::size_t more = 0)
    {
        Bytes bytes = good;
        bytes[at] = value;
        bytes.resize(bytes.size() + more);
        return ReadClaim(bytes).has_value();
    };
    EXPECT_TRUE(with(0, 1));
    EXPECT_FALSE(with(0, 2));      // another format
    EXPECT_FALSE(with(1, 0));      // no header
    EXPECT_FALSE(with(1, 5, 80));  // five
    EXPECT_TRUE(with(2, 64, 512));
    EXPECT_FALSE(with(2, 65, 520));
    EXPECT_TRUE(with(31, 250, 250));  // the size of a certificate
    EXPECT_FALSE(with(31, 251, 251));
    EXPECT_FALSE(with(11, 'X'));  // no RTPS
    EXPECT_FALSE(with(15, 3));    // RTPS 3
}

}  // namespace
