// Sealed datagrams: their recorded bytes.
#include <gtest/gtest.h>

#include <fstream>

#include "EnvelopeVectors.h"

namespace Paths
{
extern const char *const EnvelopeVectorFile;
}

namespace Rabit::Test
{
namespace
{

EnvelopeVectors Recorded()
{
    std::ifstream file(Paths::EnvelopeVectorFile);
    return ReadVectors(file);
}

TEST(EnvelopeBytes, AreTheRecordedOnes)
{
    EXPECT_EQ(LinesOf(MakeEnvelopeVectors()), LinesOf(Recorded()));
}

TEST(EnvelopeBytes, AreAccepted)
{
    EXPECT_EQ(WrongAtB(Recorded()), "");
}

TEST(EnvelopeBytes, OfABulletinAreAccepted)
{
    const EnvelopeVectors recorded = Recorded();
    SealNodes::Authority authority;
    const auto bulletin = Envelope::Bulletin::Read(recorded.at("bulletin"), authority.Verifying);
    ASSERT_TRUE(bulletin.has_value());
    EXPECT_EQ(bulletin->Revoked(), (std::vector<Envelope::Serial>{3, 9}));
    const auto secret = bulletin->Secret(2, *Envelope::AgreementKey::Of(SealNodes::SeedOf(4, 2)));
    ASSERT_TRUE(secret.has_value());
    EXPECT_EQ(SealNodes::BytesOf(secret->Bytes()), recorded.at("next_secret"));
}

}  // namespace
}  // namespace Rabit::Test
