// `VendorInput` and receivers of the vendor's that are not there.
#include "VendorInput.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using Rabit::FastDds::Receiver;
using Rabit::FastDds::VendorInput;
namespace rtps = Rabit::FastDds::rtps;

constexpr std::uint32_t GroupPort = 7400;
constexpr std::uint32_t DiscoveryPort = 7410;
constexpr std::uint32_t CardPort = 7412;

// Keeps the datagrams that it is given, in their order.
class KeepingReceiver final : public rtps::TransportReceiverInterface
{
public:
    void OnDataReceived(const rtps::octet *data, std::uint32_t size, const rtps::Locator_t & /*local*/,
                        const rtps::Locator_t & /*remote*/) override
    {
        Datagrams.emplace_back(data, data + size);
    }
    std::vector<Bytes> Datagrams;
};

Receiver At(std::uint32_t port, KeepingReceiver &next)
{
    Receiver receiver{&next, {}, {}};
    receiver.Local.port = port;
    return receiver;
}

class VendorInputTest : public testing::Test
{
protected:
    VendorInput Input{GroupPort};
    KeepingReceiver Discovery;
};

TEST_F(VendorInputTest, AMessageIsHandedToTheReceiverOfTheGroup)
{
    Bytes announcement = ParticipantMessage(Sender);
    VendorInput::HandOn(Input.DiscoveryReceiver(), announcement);
    Input.NoteReceiver(At(GroupPort, Discovery));
    VendorInput::HandOn(Input.DiscoveryReceiver(), announcement);
    EXPECT_EQ(Discovery.Datagrams, std::vector<Bytes>{announcement});
}

TEST_F(VendorInputTest, ThePortsThatTheOwnParticipantAnnouncesAreForDiscovery)
{
    KeepingReceiver others;
    Input.NoteReceiver(At(DiscoveryPort, Discovery));
    Input.NoteReceiver(At(DiscoveryPort + 1, others));
    EXPECT_EQ(Input.DiscoveryReceiver().Next, nullptr);
    Input.NoteOwn(ParticipantMessage(Other, DiscoveryPort));
    EXPECT_EQ(Input.DiscoveryReceiver().Next, &Discovery);
}

TEST_F(VendorInputTest, ThePortOfCardsIsForDiscovery)
{
    Input.NoteReceiver(At(CardPort, Discovery));
    EXPECT_EQ(Input.DiscoveryReceiver().Next, nullptr);
    Input.NoteCardPort(CardPort);
    EXPECT_EQ(Input.DiscoveryReceiver().Next, &Discovery);
}

}  // namespace
