// Sealing and opening under two locks.
#include <gtest/gtest.h>

#include <thread>

#include "SealNodes.h"

namespace
{

using namespace SealNodes;

class SealLocks : public testing::Test, protected Three
{
};

TEST_F(SealLocks, AReceiverOutlivesItsSession)
{
    const Receiver toB = A.ReceiverOf(B);
    A.Epochs.Learn(2, SecondSecret, {2}, Start);
    A.Sessions.EndRevoked(A.Epochs);
    ASSERT_EQ(A.Sessions.Find(TagOf(B.Me.Own)), nullptr);
    // In its own epoch it seals what may be sent there: a bulletin.
    const Bytes datagram = Node::Taken(
        [&](auto out) { return A.Seals.SealPairwise(A.Message(), OuterClass::Bulletin, toB, out); });
    EXPECT_EQ(B.Fault(datagram), OpenFault::None);
}

// ThreadSanitizer sees what both would change.
TEST_F(SealLocks, OneThreadSealsWhileAnotherOpens)
{
    constexpr int Count = 200;
    const Receiver toB = A.ReceiverOf(B);
    std::vector<Bytes> fromB;
    for (int i = 0; i < Count; ++i)
    {
        fromB.push_back(i % 2 == 0 ? B.Pairwise(B.Message(), A) : B.ToAll(B.Message()));
    }
    std::vector<Bytes> fromA;
    std::thread sealing(
        [&]
        {
            for (int i = 0; i < Count; ++i)
            {
                fromA.push_back(Node::Taken(
                    [&](auto out)
                    { return A.Seals.SealPairwise(A.Message(), OuterClass::Traffic, toB, out); }));
                fromA.push_back(A.ToAll(A.Message()));
            }
        });
    int opened = 0;
    for (const Bytes &datagram : fromB)
    {
        opened += A.Fault(datagram) == OpenFault::None ? 1 : 0;
    }
    sealing.join();
    EXPECT_EQ(opened, Count);
    for (const Bytes &datagram : fromA)
    {
        ASSERT_EQ(B.Fault(datagram), OpenFault::None);
    }
}

}  // namespace
