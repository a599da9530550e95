// Which fragments a peer may request.
#include "guard/SentFragments.h"

#include <gtest/gtest.h>

#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using Rabit::Rtps::SentFragments;

Bytes Fragment(std::int64_t sequence, std::uint16_t size, std::uint32_t whole)
{
    return Join(
        {{0, 0, 28, 0}, Ids(), Sequence(sequence), U32(1), U16(1), U16(size), U32(whole), Bytes(size)});
}

void Send(SentFragments &sent, const Bytes &fragment)
{
    sent.Sent(Rabit::Rtps::RtpsReader(fragment, true));
}

TEST(SentFragments, ASampleHasAsManyAsItWasCutInto)
{
    SentFragments sent;
    Send(sent, Fragment(5, 1000, 2500));
    EXPECT_TRUE(sent.Has(UserWriter, 5, 1));
    EXPECT_TRUE(sent.Has(UserWriter, 5, 3));
    EXPECT_FALSE(sent.Has(UserWriter, 5, 4));
    EXPECT_FALSE(sent.Has(UserWriter, 5, 0));
}

TEST(SentFragments, WhatWasNotSentHasNone)
{
    SentFragments sent;
    Send(sent, Fragment(5, 1000, 2500));
    EXPECT_FALSE(sent.Has(UserWriter, 6, 1));
    EXPECT_FALSE(sent.Has(0x00000203, 5, 1));
}

TEST(SentFragments, TheSamplesBegunLastAreKnown)
{
    SentFragments sent;
    for (std::int64_t sequence = 1; sequence <= 10000; ++sequence)
    {
        Send(sent, Fragment(sequence, 100, 250));
        Send(sent, Fragment(sequence, 100, 250));
    }
    EXPECT_LE(sent.Size(), 4096u);
    EXPECT_TRUE(sent.Has(UserWriter, 10000, 3));
    EXPECT_TRUE(sent.Has(UserWriter, 6000, 3));
    EXPECT_FALSE(sent.Has(UserWriter, 1, 1));
}

}  // namespace
