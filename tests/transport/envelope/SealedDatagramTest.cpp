// Datagrams that one node seals and others open, or do not.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "SealNodes.h"

namespace
{

using namespace SealNodes;
namespace Rtps = Rabit::Rtps;
using std::chrono::milliseconds;
using std::chrono::seconds;

class SealedDatagram : public testing::Test, protected Three
{
protected:
    // Opens, and expects the message.
    static void ExpectOpened(Node &at, const Bytes &datagram, const Bytes &message, TimePoint now = Start)
    {
        const Opener::Result result = at.Opens.Open(datagram, now);
        ASSERT_EQ(result.Fault, OpenFault::None);
        EXPECT_EQ(BytesOf(result.Message), message);
    }
    // Both kinds of A's datagrams that B opens.
    std::vector<Bytes> OneOfEachKind() { return {A.ToAll(A.Message()), A.Pairwise(A.Message(), B)}; }
};

TEST_F(SealedDatagram, ForAllOpensAtAll)
{
    const Bytes datagram = A.ToAll(A.Message());
    ExpectOpened(B, datagram, A.Message());
    ExpectOpened(C, datagram, A.Message());
    EXPECT_EQ(datagram.size(), A.Message().size() + 71);
}

TEST_F(SealedDatagram, ForOneOpensAtThatOneAlone)
{
    const Bytes datagram = A.Pairwise(A.Message(), B);
    EXPECT_EQ(C.Fault(datagram), OpenFault::NotAuthentic);
    ExpectOpened(B, datagram, A.Message());
}

TEST_F(SealedDatagram, InPairwiseModeAddsSevenBytes)
{
    EXPECT_EQ(A.Pairwise(A.Message(), B).size(), A.Message().size() + 7);
}

TEST_F(SealedDatagram, ShowsNothingOfItsContent)
{
    const Bytes message = A.Message();
    for (const Bytes &datagram : OneOfEachKind())
    {
        EXPECT_EQ(std::search(datagram.begin(), datagram.end(), message.end() - 16, message.end()),
                  datagram.end());
    }
}

TEST_F(SealedDatagram, RestoresTheHeaderThatItBeganWith)
{
    for (const RtpsHeader &header : A.Me.Headers)
    {
        ExpectOpened(B, A.ToAll(MessageOf(header)), MessageOf(header));
        ExpectOpened(B, A.Pairwise(MessageOf(header), B), MessageOf(header));
    }
}

TEST_F(SealedDatagram, MayBeEmptyOrAsLargeAsADatagram)
{
    const Bytes empty(A.Me.Headers[0].begin(), A.Me.Headers[0].end());
    ExpectOpened(B, A.ToAll(empty), empty);
    ExpectOpened(B, A.Pairwise(empty, B), empty);
    Bytes large = A.Message(LargestDatagram - 71 - empty.size() - Rtps::SubmessageHeaderSize);
    ExpectOpened(B, A.ToAll(large), large);
    large = A.Message(LargestDatagram - 7 - empty.size() - Rtps::SubmessageHeaderSize);
    ExpectOpened(B, A.Pairwise(large, B), large);
}

TEST_F(SealedDatagram, IsRefusedWhereItWouldBeTooLarge)
{
    Bytes large(A.Me.Headers[0].begin(), A.Me.Headers[0].end());
    large.resize(LargestDatagram - 70);
    Bytes out(LargestDatagram + 1000);
    EXPECT_EQ(A.Seals.SealGroup(large, OuterClass::Traffic, out).Fault, SealFault::TooLarge);
    large.resize(LargestDatagram - 6);
    EXPECT_EQ(A.Seals.SealPairwise(large, OuterClass::Traffic, A.ReceiverOf(B), out).Fault,
              SealFault::TooLarge);
}

TEST_F(SealedDatagram, IsRefusedWhereTheBufferIsTooSmall)
{
    const Bytes message = A.Message();
    Bytes out(message.size() + 70);
    EXPECT_EQ(A.Seals.SealGroup(message, OuterClass::Traffic, out).Fault, SealFault::NoRoom);
    EXPECT_EQ(A.Seals.SealClaim({}, {}, true, std::span(out).first(200)).Fault, SealFault::NoRoom);
}

TEST_F(SealedDatagram, IsRefusedUnderAnotherSendersHeader)
{
    Bytes out(1000);
    EXPECT_EQ(A.Seals.SealGroup(B.Message(), OuterClass::Traffic, out).Fault, SealFault::NotOurs);
    EXPECT_EQ(A.Seals.SealGroup(Bytes(19), OuterClass::Traffic, out).Fault, SealFault::NotOurs);
}

TEST_F(SealedDatagram, WithAnyBitFlippedDoesNotOpen)
{
    for (const Bytes &datagram : OneOfEachKind())
    {
        for (std::size_t bit = 0; bit < 8 * datagram.size(); ++bit)
        {
            Bytes flipped = datagram;
            flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ 1 << bit % 8);
            ASSERT_NE(B.Fault(flipped), OpenFault::None) << "bit " << bit;
        }
        EXPECT_EQ(B.Fault(datagram), OpenFault::None);
    }
}

TEST_F(SealedDatagram, WithAFieldOfItsHeaderChangedSaysWhy)
{
    const Bytes datagram = A.ToAll(A.Message());
    const auto faultWith = [&](std::size_t at, std::uint8_t value)
    {
        Bytes changed = datagram;
        changed[at] = value;
        return B.Fault(changed);
    };
    EXPECT_EQ(faultWith(0, 0x00), OpenFault::Malformed);      // not sealed
    EXPECT_EQ(faultWith(0, 0x90), OpenFault::Malformed);      // the reserved kind
    EXPECT_EQ(faultWith(0, 0xa0), OpenFault::NotAuthentic);   // another kind
    EXPECT_EQ(faultWith(0, 0x84), OpenFault::NotAuthentic);   // another class
    EXPECT_EQ(faultWith(0, 0x81), OpenFault::NotAuthentic);   // another header of the session
    EXPECT_EQ(faultWith(0, 0x82), OpenFault::UnknownHeader);  // none
    EXPECT_EQ(faultWith(1, 2), OpenFault::UnknownEpoch);
    EXPECT_EQ(faultWith(3, static_cast<std::uint8_t>(datagram[3] + 1)), OpenFault::UnknownSession);
    EXPECT_EQ(faultWith(7, static_cast<std::uint8_t>(datagram[7] + 1)), OpenFault::NotAuthentic);
    EXPECT_EQ(faultWith(10, 0x70), OpenFault::NotAuthentic);
    EXPECT_EQ(faultWith(datagram.size() - 1, static_cast<std::uint8_t>(datagram.back() + 1)),
              OpenFault::NotAuthentic);
}

TEST_F(SealedDatagram, CutOrMadeLongerDoesNotOpen)
{
    for (const Bytes &datagram : OneOfEachKind())
    {
        for (std::size_t size = 0; size < datagram.size(); ++size)
        {
            ASSERT_NE(B.Fault({datagram.begin(), datagram.begin() + static_cast<std::ptrdiff_t>(size)}),
                      OpenFault::None);
        }
        Bytes longer = datagram;
        longer.push_back(0);
        EXPECT_EQ(B.Fault(longer), OpenFault::NotAuthentic);
    }
}

TEST_F(SealedDatagram, ComesOnce)
{
    for (const Bytes &datagram : OneOfEachKind())
    {
        EXPECT_EQ(B.Fault(datagram), OpenFault::None);
        EXPECT_EQ(B.Fault(datagram), OpenFault::Replayed);
    }
    EXPECT_EQ(B.Opens.Count(OpenFault::Replayed), 2u);
}

TEST_F(SealedDatagram, ThatWasDamagedMayComeWhole)
{
    for (const Bytes &datagram : OneOfEachKind())
    {
        Bytes damaged = datagram;
        damaged[20] = static_cast<std::uint8_t>(damaged[20] + 1);
        EXPECT_EQ(B.Fault(damaged), OpenFault::NotAuthentic);
        EXPECT_EQ(B.Fault(datagram), OpenFault::None);
    }
}

TEST_F(SealedDatagram, OpensInAnyOrderWithinTheWindow)
{
    std::vector<Bytes> sent;
    for (std::uint64_t i = 0; i < ReplayWindow::Size + 1; ++i)
    {
        sent.push_back(A.Pairwise(A.Message(), B));
    }
    // Some numbers were left out, where a datagram looked like statistics.
    const std::uint64_t last = A.Seals.Next() - 1;
    EXPECT_EQ(B.Fault(sent.back()), OpenFault::None);
    for (std::size_t i = sent.size() - 1; i-- > 0;)
    {
        const auto number = static_cast<std::uint64_t>(sent[i][7] | sent[i][8] << 8);
        ASSERT_EQ(B.Fault(sent[i]), last - number < ReplayWindow::Size ? OpenFault::None : OpenFault::TooOld);
    }
}

TEST_F(SealedDatagram, FromItselfIsRecognized)
{
    EXPECT_EQ(A.Fault(A.ToAll(A.Message())), OpenFault::Own);
}

TEST_F(SealedDatagram, OfAnotherSenderUnderItsTagDoesNotOpen)
{
    const Bytes ofA = A.ToAll(A.Message());
    const Bytes ofC = C.ToAll(C.Message());
    Bytes swapped = ofA;
    std::copy(ofC.begin() + 3, ofC.begin() + 7, swapped.begin() + 3);
    EXPECT_EQ(B.Fault(swapped), OpenFault::NotAuthentic);
    const Bytes toB = A.Pairwise(A.Message(), B);
    swapped = C.Pairwise(C.Message(), B);
    std::copy(toB.begin() + 3, toB.begin() + 7, swapped.begin() + 3);
    EXPECT_EQ(B.Fault(swapped), OpenFault::NotAuthentic);
}

// C knows all that a member knows: the epoch's secret, and so A's key of group mode.
class MemberAsAnother : public SealedDatagram
{
};

TEST_F(MemberAsAnother, CannotSignForIt)
{
    const std::uint64_t highest = B.Known(A).Window().Highest();
    const Bytes forged = ForgedGroup(C, A, 500);
    EXPECT_EQ(B.Fault(forged), OpenFault::BadSignature);
    // Its number was not marked.
    EXPECT_EQ(B.Fault(forged), OpenFault::BadSignature);
    EXPECT_EQ(B.Known(A).Window().Highest(), highest);
}

TEST_F(MemberAsAnother, CannotUseItsSignatureForAnotherNumberKindOrClass)
{
    // C opens A's datagram to all, takes its signature, and seals it again.
    const Bytes message = A.Message();
    Bytes work(OuterContextSize);
    const Bytes honest = A.ToAll(message);
    const std::uint64_t number = A.Seals.Next() - 1;
    WriteOuterContext(honest, number, A.Me.Own, AllSessions, A.Me.Headers[0], work);
    const SecretKey key = *GroupKey(FirstSecret, 1, A.Me.Own);
    Bytes plain(honest.size() - OuterSize - TagSize);
    ASSERT_TRUE(Aead().Open(key, number, work, std::span(honest).subspan(OuterSize), plain));

    const auto sealedAgain = [&](Outer outer, std::uint64_t as, const SessionId &receiver, std::size_t header)
    {
        Bytes datagram(honest.size());
        outer.Epoch = 1;
        outer.Tag = TagOf(A.Me.Own);
        outer.Number = static_cast<std::uint32_t>(as);
        outer.Header = static_cast<std::uint8_t>(header);
        WriteOuter(outer, datagram);
        WriteOuterContext(datagram, as, A.Me.Own, receiver, A.Me.Headers[header], work);
        EXPECT_TRUE(Aead().Seal(key, as, work, plain, std::span(datagram).subspan(OuterSize)));
        return datagram;
    };
    EXPECT_EQ(B.Fault(sealedAgain({}, number + 1, AllSessions, 0)), OpenFault::BadSignature);
    // A datagram that is signed and names its receiver is of no kind: C could take the session that it names.
    EXPECT_EQ(B.Fault(sealedAgain({.Kind = OuterKind{1}}, number, B.Me.Own.Session, 0)),
              OpenFault::Malformed);
    EXPECT_EQ(B.Fault(sealedAgain({.Class = OuterClass::Meeting}, number, AllSessions, 0)),
              OpenFault::BadSignature);
    EXPECT_EQ(B.Fault(sealedAgain({}, number, AllSessions, 1)), OpenFault::BadSignature);
    // The same again is the datagram that A sent.
    EXPECT_EQ(sealedAgain({}, number, AllSessions, 0), honest);
    EXPECT_EQ(B.Fault(honest), OpenFault::None);
}

TEST_F(MemberAsAnother, CannotMakeThePairwiseKeyOfTwoOthers)
{
    const SecretKey wanted = A.ReceiverOf(B).Key;
    EXPECT_EQ(B.Known(A).KeyFrom(1, FirstSecret, B.Me.Agreement, B.Me.Own)->Bytes(), wanted.Bytes());
    // All that C can compute: its own secret with either, and both ends' names.
    for (const Node *with : {&A, &B})
    {
        const SecretKey shared = *C.Me.Agreement.SharedWith(with->Me.Agreement.Public());
        EXPECT_NE(PairwiseKey(FirstSecret, 1, shared, A.Me.Own, B.Me.Own)->Bytes(), wanted.Bytes());
    }
}

TEST_F(MemberAsAnother, SpeaksPairwiseForItsOwnSessionAlone)
{
    // C seals with the key that it shares with B, and names A's tag.
    Bytes forged = C.Pairwise(C.Message(), B);
    const SessionTag tag = TagOf(A.Me.Own);
    for (std::size_t i = 0; i < 4; ++i)
    {
        forged[3 + i] = static_cast<std::uint8_t>(tag >> 8 * i);
    }
    EXPECT_EQ(B.Fault(forged), OpenFault::NotAuthentic);
}

TEST_F(SealedDatagram, BackToItsSenderDoesNotOpen)
{
    // Both directions have keys of their own.
    const Bytes toB = A.Pairwise(A.Message(), B);
    Bytes back = toB;
    const SessionTag tag = TagOf(B.Me.Own);
    for (std::size_t i = 0; i < 4; ++i)
    {
        back[3 + i] = static_cast<std::uint8_t>(tag >> 8 * i);
    }
    EXPECT_EQ(A.Fault(back), OpenFault::NotAuthentic);
}

// Messages of A with an INFO_SRC.
class SealedSource : public SealedDatagram
{
protected:
    // `front`: submessages in front of it.
    Bytes WithSource(const RtpsHeader &source, const Bytes &front = {}) const
    {
        Bytes message(A.Me.Headers[0].begin(), A.Me.Headers[0].end());
        message.insert(message.end(), front.begin(), front.end());
        message.insert(message.end(), {0x0c, 0x01, 20, 0, 0, 0, 0, 0});
        message.insert(message.end(), source.begin() + 4, source.end());
        return message;
    }
};

TEST_F(SealedSource, IsOneThatTheSenderHasBound)
{
    ExpectOpened(B, A.ToAll(WithSource(A.Me.Headers[1])), WithSource(A.Me.Headers[1]));
    const Bytes foreign = A.Pairwise(WithSource(C.Me.Headers[0]), B);
    EXPECT_EQ(B.Fault(foreign), OpenFault::ForeignSource);
    EXPECT_EQ(B.Fault(foreign), OpenFault::Replayed);
    Bytes cut = WithSource(A.Me.Headers[0]);
    cut.resize(cut.size() - 8);
    EXPECT_EQ(B.Fault(A.ToAll(cut)), OpenFault::ForeignSource);
}

TEST_F(SealedSource, IsNotHiddenInASubmessageWhoseEndParsersRoundUp)
{
    // A PAD of 2 bytes. Without rounding up, a second PAD begins 2 bytes in front of INFO_SRC and swallows
    // it.
    const Bytes front = {0x01, 0x01, 2, 0, 0, 0, 0x01, 0x01};
    EXPECT_EQ(B.Fault(A.ToAll(WithSource(C.Me.Headers[0], front))), OpenFault::ForeignSource);
}

TEST_F(SealedSource, HasItsLengthAndItsVersion)
{
    Bytes longer = WithSource(A.Me.Headers[0]);
    longer[Rtps::RtpsHeaderSize + 2] = 24;
    longer.resize(longer.size() + 4);
    EXPECT_EQ(B.Fault(A.ToAll(longer)), OpenFault::ForeignSource);
    RtpsHeader other = A.Me.Headers[0];
    other[4] = 3;
    EXPECT_EQ(B.Fault(A.ToAll(WithSource(other))), OpenFault::ForeignSource);
}

TEST_F(SealedDatagram, OfTwoSessionsOfANodeOpensInEach)
{
    Node other(Signs, "uav1", 1, 1);
    B.Meet(other);
    const Bytes ofFirst = A.ToAll(A.Message());
    const Bytes ofSecond = other.ToAll(other.Message());
    ExpectOpened(B, ofFirst, A.Message());
    ExpectOpened(B, ofSecond, other.Message());
    Bytes swapped = A.ToAll(A.Message());
    std::copy(ofSecond.begin() + 3, ofSecond.begin() + 7, swapped.begin() + 3);
    swapped[7] = 99;
    EXPECT_EQ(B.Fault(swapped), OpenFault::NotAuthentic);
}

TEST_F(SealedDatagram, ForAFormerSessionOfTheReceiverDoesNotOpen)
{
    const Bytes toOld = A.Pairwise(A.Message(), B);
    Node again(Signs, "uav2", 2, 1);
    again.Meet(A);
    EXPECT_EQ(again.Fault(toOld), OpenFault::TooOld);  // below the proof
    // A later number does not help it.
    const Bytes later = A.Pairwise(A.Message(), B);
    EXPECT_EQ(again.Fault(later), OpenFault::NotAuthentic);
}

TEST(SealedNumbers, BeginAtNothingAndAreNeverUsedTwice)
{
    Three three;
    const std::uint64_t before = three.A.Seals.Next();
    EXPECT_EQ(Node(three.Signs, "uav9", 9).Seals.Next(), 0u);
    three.A.ToAll(three.A.Message());
    three.A.Pairwise(three.A.Message(), three.B);
    EXPECT_GE(three.A.Seals.Next(), before + 2);
}

TEST(SealedNumbers, OfOneSessionAreTheSameForEachOfItsSealers)
{
    Three three;
    const std::uint64_t before = three.A.Seals.Next();
    Sealer second(three.A.Me, three.A.Epochs);
    EXPECT_EQ(second.Next(), before);
    three.A.ToAll(three.A.Message());
    EXPECT_EQ(second.Next(), three.A.Seals.Next());
    EXPECT_GT(second.Next(), before);
}

TEST(SealedNumbers, WrapInTheirLowHalf)
{
    Authority authority;
    constexpr std::uint64_t Near = (std::uint64_t{1} << 32) - 20;
    Node sender(authority, "uav1", 1, 0, Near);
    Node receiver(authority, "uav2", 2);
    receiver.Meet(sender);
    sender.Meet(receiver);
    while (sender.Seals.Next() < Near + 60)
    {
        ASSERT_EQ(receiver.Fault(sender.ToAll(sender.Message())), OpenFault::None);
        ASSERT_EQ(receiver.Fault(sender.Pairwise(sender.Message(), receiver)), OpenFault::None);
    }
    // A receiver that comes later learns the high half from the claim.
    Node late(authority, "uav3", 3);
    late.Meet(sender);
    EXPECT_EQ(late.Fault(sender.ToAll(sender.Message())), OpenFault::None);
    EXPECT_GT(late.Known(sender).Window().Highest(), std::uint64_t{1} << 32);
}

TEST(SealedNumbers, EndWithoutOneUsedTwice)
{
    Authority authority;
    Node sender(authority, "uav1", 1, 0, std::numeric_limits<std::uint64_t>::max() - 10);
    Bytes out(1000);
    SealFault fault = SealFault::None;
    for (int i = 0; i < 11 && fault == SealFault::None; ++i)
    {
        fault = sender.Seals.SealGroup(sender.Message(), OuterClass::Traffic, out).Fault;
    }
    EXPECT_EQ(fault, SealFault::NumbersEnded);
    EXPECT_EQ(sender.Seals.Next(), std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(sender.Seals.SealClaim({}, {}, true, out).Fault, SealFault::NumbersEnded);
}

}  // namespace
