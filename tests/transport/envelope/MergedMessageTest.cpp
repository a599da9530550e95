// Several RTPS messages in one.
#include "envelope/MergedMessage.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "common/RtpsReader.h"
#include "guard/RtpsBytes.h"

namespace
{

using namespace RtpsBytes;
using Rabit::Rtps::ConstSubmessage;
using Rabit::Rtps::MergedMessage;

const Bytes Time = Submessage(InfoTimestamp, {1, 2, 3, 4, 5, 6, 7, 8});
const Bytes NoTime = Submessage(InfoTimestamp, {}, 3);
const Bytes ForAll = Submessage(InfoDestination, Bytes(12));
const Bytes Sample = Submessage(Data, DataBody(1), 5);
const Bytes Beat = Submessage(Heartbeat, HeartbeatBody(1, 1, 1));

Bytes To(const GuidPrefix &peer)
{
    return Submessage(InfoDestination, Bytes(peer.begin(), peer.end()));
}

Bytes Of(std::initializer_list<Bytes> submessages)
{
    Bytes message = Header();
    for (const Bytes &submessage : submessages)
    {
        message.insert(message.end(), submessage.begin(), submessage.end());
    }
    return message;
}

constexpr std::size_t Most = 1000;

Bytes Merged(std::initializer_list<Bytes> parts, std::size_t most = Most)
{
    MergedMessage whole(most);
    for (const Bytes &part : parts)
    {
        EXPECT_GT(whole.Add(part), 0u);
    }
    return whole.Bytes();
}

// True if `part` may follow `first`, of the same sender.
bool Follows(const Bytes &first, const Bytes &part, std::size_t most = Most)
{
    MergedMessage whole(most);
    EXPECT_EQ(whole.Add(first), first.size());
    const std::size_t grown = whole.Add(part);
    EXPECT_EQ(whole.Bytes().size(), first.size() + grown);
    EXPECT_TRUE(grown > 0 || whole.Bytes() == first) << "a refused part changes nothing";
    return grown > 0;
}

// The submessages that a receiver reads, each with the destination and the time that hold for it.
std::vector<Bytes> ReadOf(const Bytes &message)
{
    std::vector<Bytes> found;
    GuidPrefix to{};
    Bytes time;
    const auto visit = [&](const ConstSubmessage &submessage)
    {
        const auto body = submessage.Body();
        switch (static_cast<std::uint8_t>(submessage.Kind))
        {
            case InfoDestination:
                to = Rabit::Rtps::PrefixOf(body);
                break;
            case InfoTimestamp:
                time = (submessage.Flags & 2) != 0 ? Bytes() : Bytes(body.begin(), body.end());
                break;
            default:
            {
                const bool hasTime = static_cast<std::uint8_t>(submessage.Kind) == Data;
                found.push_back(Join({{static_cast<std::uint8_t>(submessage.Kind), submessage.Flags},
                                      Bytes(to.begin(), to.end()),
                                      hasTime ? time : Bytes(),
                                      Bytes(body.begin(), body.end())}));
                break;
            }
        }
    };
    Rabit::Rtps::VisitSubmessages(std::span<const std::uint8_t>(message), visit);
    return found;
}

TEST(MergedMessage, OnePartStaysAsItIs)
{
    for (const Bytes &part : {Of({Sample}), Of({Source(Other), Sample}), Bytes{1, 2, 3}, Bytes(2 * Most)})
    {
        EXPECT_EQ(Merged({part}), part);
    }
}

TEST(MergedMessage, APartFollowsWithoutItsHeader)
{
    EXPECT_EQ(Merged({Of({Sample}), Of({Beat})}), Of({Sample, Beat}));
    EXPECT_EQ(Merged({Of({Time, Sample}), Of({Time, Beat}), Of({Time, Sample})}),
              Of({Time, Sample, Time, Beat, Time, Sample}));
}

TEST(MergedMessage, WhatAPartDoesNotNameIsTakenBackInFrontOfIt)
{
    EXPECT_EQ(Merged({Of({To(Other), Beat}), Of({Beat})}), Of({To(Other), Beat, ForAll, Beat}));
    EXPECT_EQ(Merged({Of({Time, Sample}), Of({Sample})}), Of({Time, Sample, NoTime, Sample}));
    EXPECT_EQ(Merged({Of({To(Other), Time, Sample}), Of({Sample})}),
              Of({To(Other), Time, Sample, ForAll, NoTime, Sample}));
}

TEST(MergedMessage, WhatAPartNamesItselfNeedsNothing)
{
    EXPECT_EQ(Merged({Of({To(Other), Beat}), Of({To(Sender), Beat})}),
              Of({To(Other), Beat, To(Sender), Beat}));
    EXPECT_EQ(Merged({Of({To(Other), Beat}), Of({ForAll, Beat}), Of({Beat})}),
              Of({To(Other), Beat, ForAll, Beat, Beat}));
    EXPECT_EQ(Merged({Of({Time, Sample}), Of({NoTime, Sample}), Of({Sample})}),
              Of({Time, Sample, NoTime, Sample, Sample}));
}

// A heartbeat has no time, so it leaves that of the part before it in force.
TEST(MergedMessage, ATimeIsTakenBackBehindAPartThatDoesNotNeedOne)
{
    EXPECT_EQ(Merged({Of({Time, Sample}), Of({Beat}), Of({Sample})}),
              Of({Time, Sample, Beat, NoTime, Sample}));
}

TEST(MergedMessage, ADestinationNamedTooLateIsNotThatOfThePartsBeginning)
{
    EXPECT_EQ(Merged({Of({To(Other), Beat}), Of({Beat, To(Sender), Beat})}),
              Of({To(Other), Beat, ForAll, Beat, To(Sender), Beat}));
}

TEST(MergedMessage, ALengthThatIsLeftOutIsWrittenOutOnceAPartFollows)
{
    for (const bool littleEndian : {true, false})
    {
        const std::uint8_t flags = littleEndian ? 5 : 4;
        const Bytes body = DataBody(1);
        const Bytes open = Join({{Data, flags, 0, 0}, body});
        const auto size = static_cast<std::uint8_t>(body.size());
        const Bytes closed =
            Join({littleEndian ? Bytes{Data, flags, size, 0} : Bytes{Data, flags, 0, size}, body});
        EXPECT_EQ(Merged({Of({Beat, open})}), Of({Beat, open}));
        EXPECT_EQ(Merged({Of({Beat, open}), Of({Beat})}), Of({Beat, closed, Beat}));
        EXPECT_EQ(Merged({Of({Beat}), Of({open}), Of({Beat})}), Of({Beat, closed, Beat}));
        EXPECT_EQ(Merged({Of({To(Other), Beat}), Of({open}), Of({Beat})}),
                  Of({To(Other), Beat, ForAll, closed, Beat}));
    }
    const Bytes tooLong = Of({Join({{Data, 5, 0, 0}, DataBody(1, Bytes(65536))})});
    EXPECT_FALSE(Follows(tooLong, Of({Beat}), 100'000));
    const Bytes empty = Of({{Data, 5, 0, 0}});
    EXPECT_FALSE(Follows(empty, Of({Beat})));
    EXPECT_TRUE(Follows(Of({Beat, Submessage(1, {})}), Of({Beat}))) << "padding of no bytes";
}

TEST(MergedMessage, NothingIsJoinedWithWhatChangesMoreThanDestinationAndTime)
{
    constexpr std::uint8_t InfoReplyIp4 = 0x0d;
    for (const Bytes &odd :
         {Of({Source(Other), Sample}), Of({Submessage(InfoReply, Bytes(28)), Sample}),
          Of({Submessage(InfoReplyIp4, Bytes(8)), Sample}), Of({Submessage(SecurePrefix, Bytes(20)), Sample}),
          Of({Sample, Submessage(Statistics, Bytes(56))}),
          Of({Submessage(InfoDestination, Bytes(8)), Sample}),
          Of({Submessage(InfoTimestamp, Bytes(4)), Sample})})
    {
        EXPECT_FALSE(Follows(odd, Of({Sample})));
        EXPECT_FALSE(Follows(Of({Sample}), odd));
    }
}

TEST(MergedMessage, AMessageOfAnotherSenderStaysApart)
{
    const Bytes other = Join({Header(Other), Sample});
    EXPECT_FALSE(Follows(Of({Sample}), other));
    Bytes otherVersion = Of({Sample});
    otherVersion[5] = 1;
    EXPECT_FALSE(Follows(Of({Sample}), otherVersion));
}

TEST(MergedMessage, NothingFollowsWhatEndsElsewhereThanAtAMultipleOfFourBytes)
{
    const Bytes odd = Of({Submessage(Data, DataBody(1, {0, 1, 0, 0, 7}), 5)});
    EXPECT_FALSE(Follows(odd, Of({Sample})));
    EXPECT_TRUE(Follows(Of({Sample}), odd)) << "as the last part";
    Bytes cut = Of({Sample});
    cut.resize(cut.size() - 4);
    EXPECT_FALSE(Follows(cut, Of({Sample})));
    EXPECT_FALSE(Follows(Join({Of({Sample}), Bytes(2)}), Of({Sample})));
}

TEST(MergedMessage, TheLimitHoldsForTheWholeWithWhatGoesInBetween)
{
    const Bytes first = Of({To(Other), Time, Sample});
    const std::size_t whole = first.size() + ForAll.size() + NoTime.size() + Sample.size();
    EXPECT_TRUE(Follows(first, Of({Sample}), whole));
    EXPECT_FALSE(Follows(first, Of({Sample}), whole - 1));
}

TEST(MergedMessage, APartMayFollowOneThatWasRefused)
{
    MergedMessage whole(100);
    ASSERT_GT(whole.Add(Of({Time, Sample})), 0u);
    ASSERT_EQ(whole.Add(Of({Submessage(Data, DataBody(2, Bytes(200)), 5)})), 0u);
    EXPECT_EQ(whole.Add(Of({Beat})), Beat.size());
    EXPECT_EQ(whole.Bytes(), Of({Time, Sample, Beat}));
}

// Every sequence of three parts of these kinds says what its parts say alone.
TEST(MergedMessage, AReceiverReadsWhatThePartsSayAlone)
{
    const std::vector<Bytes> parts{Of({Sample}),
                                   Of({Beat}),
                                   Of({Time, Sample}),
                                   Of({To(Other), Beat}),
                                   Of({To(Other), Time, Sample, Beat}),
                                   Of({Time, Sample, To(Sender), Beat}),
                                   Of({ForAll, NoTime, Sample}),
                                   Of({Sample, Time, Sample}),
                                   Of({Time}),
                                   Of({To(Other)}),
                                   Of({Beat, {Data, 5, 0, 0}, DataBody(3)})};
    for (const Bytes &first : parts)
    {
        for (const Bytes &second : parts)
        {
            for (const Bytes &third : parts)
            {
                auto alone = ReadOf(first);
                for (const Bytes &part : {second, third})
                {
                    const auto read = ReadOf(part);
                    alone.insert(alone.end(), read.begin(), read.end());
                }
                EXPECT_EQ(ReadOf(Merged({first, second, third})), alone);
            }
        }
    }
}

}  // namespace
