// Certificates, permissions, bulletins and epochs.
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "SealNodes.h"

namespace
{

using namespace SealNodes;
using std::chrono::milliseconds;
using std::chrono::minutes;

// Changes each bit in turn and hands over the bytes.
template <typename Visit>
void VisitFlipped(const Bytes &bytes, const Visit &visit)
{
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit)
    {
        Bytes flipped = bytes;
        flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ 1 << bit % 8);
        visit(flipped);
    }
}

const Certificate Full = {.Name = "uav1.vision_2-x",
                          .Role = CertificateRole::Tool,
                          .Number = 0x01020304,
                          .Begins = 5,
                          .Ends = 0xffffffff,
                          .Signing = {1, 2, 3},
                          .Agreement = {4, 5, 6},
                          .Permissions = {7, 8, 9}};

TEST(SealCertificate, IsTheSameAfterWritingAndReading)
{
    Authority authority;
    const Bytes bytes = WriteCertificate(Full, authority.Signing);
    EXPECT_EQ(ReadCertificate(bytes), Full);
    EXPECT_TRUE(IsCertifiedBy(bytes, authority.Verifying));
}

TEST(SealCertificate, HasAtMost250Bytes)
{
    Authority authority;
    Certificate longest = Full;
    longest.Name = std::string(LongestCertificateName, 'n');
    const Bytes bytes = WriteCertificate(longest, authority.Signing);
    EXPECT_LE(bytes.size(), LargestCertificate);
    EXPECT_EQ(ReadCertificate(bytes), longest);
    longest.Name += 'n';
    EXPECT_TRUE(WriteCertificate(longest, authority.Signing).empty());
}

TEST(SealCertificate, HasANameOfPlainCharacters)
{
    Authority authority;
    for (const std::string name : {"", "a b", "uav*", "a/b", "\xc3\xa4", "a\n"})
    {
        Certificate certificate = Full;
        certificate.Name = name;
        EXPECT_TRUE(WriteCertificate(certificate, authority.Signing).empty()) << name;
        // Nor is one read that the authority signed by mistake.
        certificate.Name = std::string(name.size(), 'x');
        Bytes bytes = WriteCertificate(certificate, authority.Signing);
        std::copy(name.begin(), name.end(), bytes.empty() ? bytes.begin() : bytes.begin() + 111);
        EXPECT_FALSE(ReadCertificate(bytes).has_value()) << name;
    }
}

TEST(SealCertificate, WithAnyBitFlippedIsNotTheAuthoritys)
{
    Authority authority;
    VisitFlipped(WriteCertificate(Full, authority.Signing), [&](const Bytes &flipped)
                 { EXPECT_FALSE(ReadCertificate(flipped) && IsCertifiedBy(flipped, authority.Verifying)); });
}

TEST(SealCertificate, CutOrMadeLongerIsNone)
{
    Authority authority;
    Bytes bytes = WriteCertificate(Full, authority.Signing);
    for (std::size_t size = 0; size < bytes.size(); ++size)
    {
        EXPECT_FALSE(ReadCertificate(std::span(bytes).first(size)).has_value());
        EXPECT_FALSE(IsCertifiedBy(std::span(bytes).first(size), authority.Verifying));
    }
    bytes.push_back(0);
    EXPECT_FALSE(ReadCertificate(bytes).has_value());
}

TEST(SealCertificate, OfAnotherAuthorityIsNotTheAuthoritys)
{
    Authority authority;
    SigningKey other = *SigningKey::Of(SeedOf(9, 1));
    EXPECT_FALSE(IsCertifiedBy(WriteCertificate(Full, other), authority.Verifying));
}

TEST(SealCertificate, FitsItsKeys)
{
    Authority authority;
    const Bytes bytes = authority.Certify("uav1", 1, 1);
    const std::vector<RtpsHeader> headers{HeaderOf(1)};
    EXPECT_TRUE(Self::Of(SeedOf(3, 1), SeedOf(4, 1), {}, bytes, headers).has_value());
    EXPECT_FALSE(Self::Of(SeedOf(3, 2), SeedOf(4, 1), {}, bytes, headers).has_value());
    EXPECT_FALSE(Self::Of(SeedOf(3, 1), SeedOf(4, 2), {}, bytes, headers).has_value());
    EXPECT_FALSE(Self::Of(SeedOf(3, 1), SeedOf(4, 1), {}, {}, headers).has_value());
    EXPECT_FALSE(Self::Of(SeedOf(3, 1), SeedOf(4, 1), {}, bytes, {}).has_value());
    EXPECT_FALSE(
        Self::Of(SeedOf(3, 1), SeedOf(4, 1), {}, bytes, std::vector<RtpsHeader>(5, HeaderOf(1))).has_value());
}

TEST(SealAgreement, IsTheSameForBothAndRefusesPointsOfLowOrder)
{
    const AgreementKey a = *AgreementKey::Of(SeedOf(4, 1));
    const AgreementKey b = *AgreementKey::Of(SeedOf(4, 2));
    EXPECT_EQ(a.SharedWith(b.Public())->Bytes(), b.SharedWith(a.Public())->Bytes());
    EXPECT_FALSE(a.SharedWith({}).has_value());
    EXPECT_FALSE(a.SharedWith({1}).has_value());
}

std::optional<Permissions> ListOf(const std::string &topic, bool mayWrite, bool mayRead)
{
    return Permissions::Of({{.Topic = topic, .MayWrite = mayWrite, .MayRead = mayRead}});
}

TEST(SealPermissions, AllowWhatTheyNameAndNothingElse)
{
    const Permissions list = *Permissions::Of({{.Topic = "Pose", .MayWrite = true},
                                               {.Topic = "rabit/*", .MayRead = true},
                                               {.Topic = "Both", .MayWrite = true, .MayRead = true}});
    EXPECT_TRUE(list.MayWrite("Pose", CertificateRole::Node));
    EXPECT_FALSE(list.MayRead("Pose"));
    EXPECT_TRUE(list.MayRead("rabit/Link"));
    EXPECT_FALSE(list.MayWrite("rabit/Link", CertificateRole::Node));
    EXPECT_TRUE(list.MayWrite("Both", CertificateRole::Node));
    EXPECT_TRUE(list.MayRead("Both"));
    EXPECT_FALSE(list.MayRead("Other"));
    EXPECT_FALSE(Permissions::Of({})->MayRead("Pose"));
}

TEST(SealPermissions, LetAToolWriteTheGatewaysTopicsAlone)
{
    EXPECT_TRUE(ListOf("*", true, true)->MayWrite("rabit/Beat", CertificateRole::Tool));
    EXPECT_FALSE(ListOf("Pose", true, true)->MayWrite("rabit/Beat", CertificateRole::Tool));
    EXPECT_FALSE(ListOf("*", true, true)->MayWrite("Pose", CertificateRole::Tool));
    EXPECT_TRUE(ListOf("*", true, true)->MayRead("Pose"));
}

TEST(SealPermissions, MatchPatterns)
{
    const auto matches = [](const std::string &pattern, std::string_view topic)
    { return ListOf(pattern, false, true)->MayRead(topic); };
    EXPECT_TRUE(matches("*", ""));
    EXPECT_TRUE(matches("a*c", "abbc"));
    EXPECT_TRUE(matches("a*b*c", "aXbYbc"));
    EXPECT_TRUE(matches("a?c", "abc"));
    EXPECT_TRUE(matches("*a", "a*a"));
    EXPECT_TRUE(matches("a*", "a"));
    EXPECT_FALSE(matches("a", "ab"));
    EXPECT_FALSE(matches("a", ""));
    EXPECT_FALSE(matches("a?c", "ac"));
    EXPECT_FALSE(matches("a*c", "abcd"));
    EXPECT_FALSE(matches("*b*c", "acb"));
}

TEST(SealPermissions, AreTheSameAfterWritingAndReading)
{
    const Permissions list = *Permissions::Of(
        {{.Topic = "Pose", .MayWrite = true}, {.Topic = std::string(255, 'x'), .MayRead = true}});
    const auto read = Permissions::Read(list.Bytes());
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->Rules(), list.Rules());
    EXPECT_EQ(Permissions::HashOf(list.Bytes()), Permissions::HashOf(read->Bytes()));
}

TEST(SealPermissions, OutsideOfTheirLimitsAreRefused)
{
    EXPECT_FALSE(ListOf("", true, true).has_value());
    EXPECT_FALSE(ListOf(std::string(256, 'x'), true, true).has_value());
    EXPECT_FALSE(ListOf("a*b*c*d*e*", true, true).has_value());
    EXPECT_FALSE(ListOf("a", false, false).has_value());
    EXPECT_FALSE(
        Permissions::Of(std::vector<Permissions::Rule>(257, {.Topic = "a", .MayRead = true})).has_value());
    EXPECT_FALSE(
        Permissions::Of(std::vector<Permissions::Rule>(70, {.Topic = std::string(250, 'a'), .MayRead = true}))
            .has_value());
    const Bytes good = ListOf("Pose", true, true)->Bytes();
    EXPECT_EQ(good, (Bytes{1, 3, 4, 'P', 'o', 's', 'e'}));
    for (std::size_t size = 2; size < good.size(); ++size)
    {
        EXPECT_FALSE(Permissions::Read(std::span(good).first(size)).has_value());
    }
    EXPECT_TRUE(Permissions::Read(std::span(good).first(1)).has_value());  // an empty list
    EXPECT_FALSE(Permissions::Read({}).has_value());
    EXPECT_FALSE(Permissions::Read(Bytes{2, 3, 1, 'a'}).has_value());
    EXPECT_FALSE(Permissions::Read(Bytes{1, 4, 1, 'a'}).has_value());
}

class SealBulletin : public testing::Test
{
protected:
    Bytes Written(std::vector<Serial> revoked = {9, 3}, std::vector<std::uint8_t> nodes = {2, 1},
                  Epoch epoch = 2)
    {
        std::vector<BulletinNode> all;
        for (const std::uint8_t node : nodes)
        {
            all.push_back({.Number = node, .Agreement = AgreementKey::Of(SeedOf(4, node))->Public()});
        }
        return Bulletin::Write(epoch, std::move(revoked), std::move(all), SecondSecret, Once, Signs.Signing);
    }

    Authority Signs;
    AgreementKey Once = *AgreementKey::Of(SeedOf(5, 0));
};

TEST_F(SealBulletin, GivesTheSecretToEachNodeThatIsNotRevoked)
{
    const Bytes bytes = Written();
    const auto read = Bulletin::Read(bytes, Signs.Verifying);
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->Epoch(), 2);
    EXPECT_EQ(read->Revoked(), (std::vector<Serial>{3, 9}));
    for (const std::uint8_t node : {std::uint8_t{1}, std::uint8_t{2}})
    {
        const auto secret = read->Secret(node, *AgreementKey::Of(SeedOf(4, node)));
        ASSERT_TRUE(secret.has_value());
        EXPECT_EQ(secret->Bytes(), SecondSecret.Bytes());
    }
    EXPECT_FALSE(read->Secret(3, *AgreementKey::Of(SeedOf(4, 3))).has_value());
    // Another's entry does not open.
    EXPECT_FALSE(read->Secret(1, *AgreementKey::Of(SeedOf(4, 3))).has_value());
}

TEST_F(SealBulletin, Has52BytesForANode)
{
    EXPECT_EQ(Written({}, {1, 2, 3}).size() - Written({}, {1, 2}).size(), 52u);
    EXPECT_EQ(Written({4}, {1}).size() - Written({}, {1}).size(), 4u);
}

TEST_F(SealBulletin, EncryptsUnderAKeyForEachSerial)
{
    const PublicKey same = AgreementKey::Of(SeedOf(4, 1))->Public();
    const Bytes bytes =
        Bulletin::Write(2, {}, {{.Number = 1, .Agreement = same}, {.Number = 7, .Agreement = same}},
                        SecondSecret, Once, Signs.Signing);
    // Entries of 52 bytes begin at 39. Behind the serial is the encrypted secret.
    const auto encrypted = [&bytes](std::size_t entry)
    { return BytesOf(std::span(bytes).subspan(39 + 52 * entry + 4, 32)); };
    EXPECT_NE(encrypted(0), encrypted(1));
}

TEST_F(SealBulletin, WithAnyBitFlippedIsNone)
{
    VisitFlipped(Written(), [this](const Bytes &flipped)
                 { EXPECT_FALSE(Bulletin::Read(flipped, Signs.Verifying).has_value()); });
}

TEST_F(SealBulletin, CutOrMadeLongerIsNone)
{
    Bytes bytes = Written();
    for (std::size_t size = 0; size < bytes.size(); ++size)
    {
        EXPECT_FALSE(Bulletin::Read(std::span(bytes).first(size), Signs.Verifying).has_value());
    }
    bytes.push_back(0);
    EXPECT_FALSE(Bulletin::Read(bytes, Signs.Verifying).has_value());
}

TEST_F(SealBulletin, IsNotWrittenWithContradictions)
{
    EXPECT_TRUE(Written({1}, {1, 2}).empty());  // revoked and named
    EXPECT_TRUE(Written({3, 3}, {1}).empty());  // twice
    EXPECT_TRUE(Written({}, {1, 1}).empty());   // twice
    EXPECT_TRUE(Written({}, {1}, 0).empty());   // no epoch
    EXPECT_TRUE(Written(std::vector<Serial>(MostRevoked + 1), {1}).empty());
    EXPECT_FALSE(Written({}, {}).empty());
    EXPECT_TRUE(
        Bulletin::Write(2, {}, {{.Number = 1}}, SecondSecret, Once, Signs.Signing).empty());  // low order
}

TEST_F(SealBulletin, OfAnotherAuthorityIsNone)
{
    SigningKey other = *SigningKey::Of(SeedOf(9, 1));
    const Bytes bytes = Bulletin::Write(2, {}, {}, SecondSecret, Once, other);
    EXPECT_FALSE(Bulletin::Read(bytes, Signs.Verifying).has_value());
}

TEST(SealEpochs, OnlyRise)
{
    EpochSecrets epochs;
    EXPECT_EQ(epochs.Newest(), 0);
    EXPECT_EQ(epochs.Secret(0), nullptr);
    EXPECT_FALSE(epochs.Learn(0, FirstSecret, {}, Start));
    EXPECT_TRUE(epochs.Learn(5, FirstSecret, {7}, Start));
    EXPECT_FALSE(epochs.Learn(5, SecondSecret, {}, Start));
    EXPECT_FALSE(epochs.Learn(4, SecondSecret, {}, Start));
    EXPECT_EQ(epochs.Newest(), 5);
    EXPECT_EQ(epochs.Secret(5)->Bytes(), FirstSecret.Bytes());
    EXPECT_TRUE(epochs.IsRevoked(7));
    EXPECT_TRUE(epochs.Learn(std::numeric_limits<Epoch>::max(), SecondSecret, {8}, Start));
    EXPECT_FALSE(epochs.IsRevoked(7));
    EXPECT_TRUE(epochs.IsRevoked(8));
}

TEST(SealEpochs, AreUsedForTenMinutesAfterTheNextOne)
{
    using Use = EpochSecrets::Use;
    EpochSecrets epochs;
    epochs.Learn(1, FirstSecret, {}, Start);
    EXPECT_EQ(epochs.UseOf(1, Start + minutes(600)), Use::All);
    EXPECT_EQ(epochs.UseOf(2, Start), Use::None);
    epochs.Learn(2, SecondSecret, {}, Start + minutes(60));
    EXPECT_EQ(epochs.UseOf(1, Start + minutes(70)), Use::All);
    EXPECT_EQ(epochs.UseOf(1, Start + minutes(70) + milliseconds(1)), Use::Bulletin);
    EXPECT_EQ(epochs.UseOf(2, Start + minutes(700)), Use::All);
    // A third epoch does not bring the first one back.
    epochs.Learn(3, FirstSecret, {}, Start + minutes(80));
    EXPECT_EQ(epochs.UseOf(1, Start + minutes(80)), Use::Bulletin);
    EXPECT_EQ(epochs.UseOf(2, Start + minutes(80)), Use::All);
}

TEST(SealEpochs, AreBounded)
{
    EpochSecrets epochs;
    for (Epoch epoch = 1; epoch <= 20; ++epoch)
    {
        epochs.Learn(epoch, FirstSecret, {}, Start);
    }
    EXPECT_EQ(epochs.Secret(20 - EpochSecrets::Most), nullptr);
    EXPECT_EQ(epochs.UseOf(20 - EpochSecrets::Most, Start), EpochSecrets::Use::None);
    EXPECT_NE(epochs.Secret(20 - EpochSecrets::Most + 1), nullptr);
}

// RFC 5869, A.1.
TEST(SealKeys, AreThoseOfTheStandard)
{
    const Bytes secret(22, 0x0b);
    const Bytes salt = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    const Bytes info = {0xf0, 0xf1, 0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8, 0xf9};
    const SecretKey::Content expected = {0x3c, 0xb2, 0x5f, 0x25, 0xfa, 0xac, 0xd5, 0x7a, 0x90, 0x43, 0x4f,
                                         0x64, 0xd0, 0x36, 0x2f, 0x2a, 0x2d, 0x2d, 0x0a, 0x90, 0xcf, 0x1a,
                                         0x5a, 0x4c, 0x5d, 0xb0, 0x2d, 0x56, 0xec, 0xc4, 0xc5, 0xbf};
    EXPECT_EQ(Hkdf(salt, secret, info)->Bytes(), expected);
}

}  // namespace
