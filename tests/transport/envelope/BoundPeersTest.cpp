// Which certificate speaks by which GUID prefix.
#include "envelope/BoundPeers.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "SealNodes.h"
#include "guard/RtpsMessage.h"

namespace
{

using namespace SealNodes;

class BoundPrefixes : public testing::Test
{
protected:
    static Session SessionWith(std::uint8_t number, const RtpsHeader &header)
    {
        auto certificate = std::make_shared<KnownCertificate>(
            KnownCertificate{.Hash = {number},
                             .Content = {.Name = "uav" + std::to_string(number), .Number = number},
                             .Key = VerifyingKey::Of(SigningKey::Of(SeedOf(3, number))->Public()).value()});
        return {{.Session = SessionOf(number, 0), .Certificate = certificate->Hash},
                certificate,
                {header},
                Start};
    }
    bool Bind(const Session &session)
    {
        return Peers.Bind(session, TagOf(session.Sender()), nullptr, [](SessionTag) { return false; });
    }
    std::shared_ptr<const BoundPeer> Found(std::uint8_t number) const
    {
        return Peers.Find(Rabit::Rtps::SenderOf(HeaderOf(number)));
    }

    BoundPeers Peers;
};

TEST_F(BoundPrefixes, AreThoseOfOneCertificate)
{
    const Session first = SessionWith(1, HeaderOf(1));
    EXPECT_FALSE(Peers.Has(first));
    EXPECT_TRUE(Bind(first));
    EXPECT_TRUE(Peers.Has(first));
    EXPECT_FALSE(Peers.Has(SessionWith(2, HeaderOf(1))));
    ASSERT_TRUE(Found(1));
    EXPECT_EQ(Found(1)->Name, "uav1");
    EXPECT_FALSE(Found(2));
}

TEST_F(BoundPrefixes, StayWithTheirFirstCertificate)
{
    EXPECT_TRUE(Bind(SessionWith(1, HeaderOf(1))));
    const Session other = SessionWith(2, HeaderOf(1));
    EXPECT_FALSE(Bind(other));
    EXPECT_FALSE(Peers.Has(other));
    ASSERT_TRUE(Found(1));
    EXPECT_EQ(Found(1)->Name, "uav1");
}

TEST_F(BoundPrefixes, OfARevokedCertificateAreNobodys)
{
    EXPECT_TRUE(Bind(SessionWith(1, HeaderOf(1))));
    EXPECT_TRUE(Bind(SessionWith(3, HeaderOf(3))));
    Peers.EndIf([](const BoundPeer &peer) { return peer.Number == 1; });
    EXPECT_FALSE(Found(1));
    EXPECT_TRUE(Found(3));
    EXPECT_FALSE(Bind(SessionWith(2, HeaderOf(1))));
    EXPECT_FALSE(Found(1));
}

}  // namespace
