// Joins several messages into one, for a vendor that takes one at a time.
#include "envelope/JoinMessages.h"

#include <gtest/gtest.h>

#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using Rabit::Rtps::JoinMessages;

const Bytes FromSender = Message(Data, DataBody(1));
const Bytes FromOther = Join({Header(Other), Submessage(Data, DataBody(7))});
// Names the sender of the submessages that follow, for all receivers, without a timestamp.
const Bytes Divider =
    Join({Source(Other), Submessage(InfoDestination, Bytes(12)), Submessage(InfoTimestamp, {}, 3)});

// Returns a buffer of `size` bytes that began with `last`, after JoinMessages put `first` before it.
Bytes Joined(const std::vector<Bytes> &first, const Bytes &last, std::size_t size = 1000)
{
    Bytes buffer(last);
    buffer.resize(size);
    buffer.resize(JoinMessages(first, buffer, last.size()));
    return buffer;
}

TEST(JoinMessages, OneAloneStaysAsItIs)
{
    EXPECT_EQ(Joined({}, FromSender), FromSender);
    EXPECT_EQ(Joined({FromSender}, {}), FromSender);
    EXPECT_EQ(Joined({}, {}), Bytes());
}

TEST(JoinMessages, TheOneInTheBufferIsLastAndSaysWhatItSaidAlone)
{
    EXPECT_EQ(Joined({FromSender}, FromOther), Join({FromSender, Divider, Submessage(Data, DataBody(7))}));
}

TEST(JoinMessages, WhatWouldNotFitIsLeftOut)
{
    const std::size_t whole = Joined({FromSender}, FromOther).size();
    EXPECT_EQ(Joined({FromSender}, FromOther, whole).size(), whole);
    EXPECT_EQ(Joined({FromSender}, FromOther, whole - 1), FromSender);
}

TEST(JoinMessages, NothingFollowsAnOddLength)
{
    const Bytes odd = Message(Data, DataBody(1, {0, 1, 0, 0, 7}));
    EXPECT_EQ(Joined({odd}, FromOther), odd);
}

}  // namespace
