// The sequences of a stranger. A turn comes every 10 ms.
#include <algorithm>
#include <array>

#include "Words.h"
#include "common/RtpsWriter.h"
#include "rtps/CardMessage.h"

namespace Opponent
{

namespace
{

using namespace RtpsBytes;
using Rabit::Rtps::CardMessage;
using Rabit::Rtps::CardPartSize;
using Rabit::Rtps::LargestCard;
using Rabit::Rtps::MostCardParts;
using Rabit::Rtps::MostCardRequests;
using Rabit::Rtps::PublicationsWriter;
using Rabit::Rtps::SubscriptionsWriter;

constexpr std::int64_t FarAhead = std::int64_t{1} << 39;
// Turns from one try to the next, for sequences that need some datagrams in a row.
constexpr std::uint64_t Round = 20;

EntityId WriterNumber(std::uint64_t number)
{
    return static_cast<EntityId>((number & 0xffffff) << 8 | 0x03);
}
EntityId ReaderNumber(std::uint64_t number)
{
    return static_cast<EntityId>((number & 0xffffff) << 8 | 0x04);
}

void RisingHeartbeats(Turn &turn)
{
    const GuidPrefix name = Invented(turn.Number / Round);
    const std::uint64_t step = turn.Number % Round;
    if (step == 0)
    {
        turn.Send(Announcement(name));
    }
    else if (step <= 12)
    {
        const auto last = FarAhead + static_cast<std::int64_t>(step);
        turn.Send(Heartbeat(name, PublicationsWriter, 1, last, static_cast<std::uint32_t>(step)));
    }
}

void FarGaps(Turn &turn)
{
    const GuidPrefix name = Invented(turn.Number / Round);
    const std::uint64_t step = turn.Number % Round;
    if (step == 0)
    {
        turn.Send(Announcement(name));
        return;
    }
    const auto base = static_cast<std::int64_t>(step << (turn.Below(36)));
    turn.Send(Join(
        {Header(name), Submessage(Gap, GapBody(1, 1 + base, 256, PublicationsWriter)),
         Submessage(RtpsBytes::Heartbeat, HeartbeatBody(1 + base, 2 + base, static_cast<std::uint32_t>(step),
                                                        PublicationsWriter))}));
}

void NumbersOfOthers(Turn &turn)
{
    if (turn.Heard.Names().empty())
    {
        return;
    }
    const GuidPrefix name = turn.AnyName();
    for (const auto &[writer, highest] : turn.Heard.NumbersOf(name))
    {
        const auto step = static_cast<std::int64_t>(std::uint64_t{1} << turn.Below(40));
        const auto from = turn.Below(Addresses);
        turn.Send(
            Heartbeat(name, writer, highest + step, highest + step, static_cast<std::uint32_t>(turn.Number)),
            from);
        turn.Send(Join({Header(name), Submessage(Gap, GapBody(highest, highest + step, 0, writer))}), from);
    }
}

// Ten a second: the nodes of a test keep what each unpacks to.
void WholeNewCards(Turn &turn)
{
    if (turn.Number % 10 != 0)
    {
        return;
    }
    const GuidPrefix name = Invented(0);
    constexpr std::size_t large = 61'000;
    std::array<Bytes, 4> endpoints;
    for (std::size_t i = 0; i < endpoints.size(); ++i)
    {
        const auto number = turn.Number * endpoints.size() + i + 1;
        const Bytes data = EndpointData(name, WriterNumber(number), "Pose", "Uav::Pose", large);
        endpoints[i] = EndpointSaid(PublicationsWriter, data, static_cast<std::int64_t>(number));
    }
    for (Bytes &message :
         CardOf(name, {ParticipantSaid(name, {}), endpoints[0], endpoints[1], endpoints[2], endpoints[3]},
                turn.Now))
    {
        turn.Send(std::move(message));
    }
}

// The cards come within ten seconds. Nothing follows.
void ReadersThatAreNotThere(Turn &turn)
{
    constexpr std::uint64_t turnsOfOne = 4;
    constexpr std::uint64_t cards = 250;
    const std::uint64_t number = turn.Number / turnsOfOne;
    if (turn.Number % turnsOfOne != 0 || number >= cards)
    {
        return;
    }
    const GuidPrefix name = Invented(number);
    const Place place{.Port = static_cast<std::uint16_t>(20'000 + number)};
    const Bytes beats = EndpointData(name, ReaderNumber(1), BeatTopic, BeatType);
    const Bytes poses = EndpointData(name, ReaderNumber(2), "Pose", "Uav::Pose");
    for (Bytes &message : CardOf(name,
                                 {ParticipantSaid(name, place), EndpointSaid(SubscriptionsWriter, beats, 1),
                                  EndpointSaid(SubscriptionsWriter, poses, 2)},
                                 turn.Now))
    {
        turn.Send(std::move(message), number % Addresses);
    }
}

void GoodbyesOfOthers(Turn &turn)
{
    constexpr std::uint64_t turns = 150;
    if (turn.Number % turns == 0)
    {
        for (const GuidPrefix &name : turn.Heard.Names())
        {
            turn.Send(Goodbye(name, static_cast<std::int64_t>(2 + turn.Number)));
        }
    }
}

// In the names of others, and in its own.
void Moves(Turn &turn)
{
    const auto from = turn.Below(Addresses);
    const Place place{.Host = static_cast<std::uint8_t>(200 + turn.Below(Addresses)),
                      .Port = static_cast<std::uint16_t>(7411 + turn.Below(4))};
    const auto number = static_cast<std::int64_t>(turn.Number + 1);
    if (turn.Number % 3 != 0 && !turn.Heard.Names().empty())
    {
        turn.Send(Announcement(turn.AnyName(), place, number), from);
        return;
    }
    const GuidPrefix name = Invented(turn.Below(8));
    turn.Send(Announcement(name, place, number), from);
    turn.Send(Goodbye(name, number), turn.Below(Addresses));
}

void HalfAnswers(Turn &turn)
{
    const GuidPrefix name = Invented(turn.Number % 1000);
    const Bytes part(CardPartSize, 1);
    CardMessage message{.From = name, .Summary = {turn.Random(), LargestCard}};
    message.HasPart = true;
    message.Part = turn.Below(MostCardParts);
    message.Bytes = part;
    for (std::size_t i = 0; i < std::min(turn.Heard.Names().size(), MostCardRequests); ++i)
    {
        message.Requests.push_back({turn.Heard.Names()[i], ~std::uint64_t{0}});
    }
    turn.Send(WriteCardMessage(message), turn.Below(Addresses));
    const Bytes fragment = FragmentBody(1 + static_cast<std::uint32_t>(turn.Below(40)), 1, 1000, 60'000, 1000,
                                        PublicationsWriter);
    turn.Send(Join({Header(name), Submessage(DataFrag, fragment)}), turn.Below(Addresses));
}

void Yesterday(Turn &turn)
{
    const auto &kept = turn.Heard.Kept();
    for (int i = 0; i < 10 && !kept.empty(); ++i)
    {
        const auto &[when, datagram] = kept[turn.Below(kept.size())];
        if (turn.Now - when > std::chrono::seconds(3))
        {
            turn.Send(datagram, turn.Below(Addresses));
        }
    }
}

void Crowd(Turn &turn)
{
    constexpr std::uint64_t many = 10;
    for (std::uint64_t i = 0; i < many; ++i)
    {
        const auto number = turn.Number * many + i;
        const Place place{.Port = static_cast<std::uint16_t>(1024 + number % 60'000)};
        turn.Send(Announcement(Invented(number), place), turn.Below(Addresses));
    }
}

void UnknownSenders(Turn &turn)
{
    for (int i = 0; i < 10; ++i)
    {
        const GuidPrefix name = Invented(turn.Random());
        turn.Send(Join({Header(name), Submessage(Data, DataBody(1))}), turn.Below(Addresses));
    }
}

void RequestsForAll(Turn &turn)
{
    const GuidPrefix name = Invented(turn.Number % 20);
    if (turn.Number < 20)
    {
        turn.Send(RtpsBytes::Join({Header(name), ParticipantSaid(name, {})}));
        return;
    }
    for (const GuidPrefix &other : turn.Heard.Names())
    {
        Bytes message = Header(name);
        Rabit::Rtps::AppendDestination(message, other);
        for (const EntityId writer : {PublicationsWriter, SubscriptionsWriter})
        {
            Bytes set = U32(256);
            set.resize(4 + 32, 0xff);
            const Bytes body = Join({Ids(writer | 0x07, writer), RtpsBytes::Sequence(1), set,
                                     U32(static_cast<std::uint32_t>(turn.Number))});
            message = Join({message, Submessage(AckNack, body)});
        }
        turn.Send(message);
    }
    CardMessage message{.From = name};
    for (std::size_t i = 0; i < std::min(turn.Heard.Names().size(), MostCardRequests); ++i)
    {
        message.Requests.push_back({turn.Heard.Names()[i], ~std::uint64_t{0}});
    }
    turn.Send(WriteCardMessage(message), turn.Below(Addresses));
}

void EndlessEndpoints(Turn &turn)
{
    const GuidPrefix name = Invented(0);
    if (turn.Number % 100 == 0)
    {
        turn.Send(Announcement(name));
    }
    const auto number = static_cast<std::int64_t>(turn.Number + 1);
    const Bytes data = EndpointData(name, WriterNumber(turn.Number + 1), "Pose", "Uav::Pose", 900);
    turn.Send(Join({Header(name), EndpointSaid(PublicationsWriter, data, number)}));
}

void Mix(Turn &turn);

constexpr std::array All{
    Sequence{"rising_heartbeats", "announces, then heartbeats whose last number is 2^39 and rises",
             RisingHeartbeats},
    Sequence{"far_gaps", "announces, then gaps and heartbeats of ever wider ranges", FarGaps},
    Sequence{"numbers_of_others", "heartbeats and gaps of others' writers, ahead of them", NumbersOfOthers},
    Sequence{"whole_new_cards", "cards of 300 bytes, each with four new endpoints of 61 kB", WholeNewCards},
    Sequence{"readers_that_are_not_there", "250 cards of participants with readers of the nodes' topics",
             ReadersThatAreNotThere},
    Sequence{"goodbyes_of_others", "says goodbye for all it has heard, once in 1.5 s", GoodbyesOfOthers},
    Sequence{"moves", "participants, others' included, that change their addresses and leave", Moves},
    Sequence{"half_answers", "summaries of large cards and one part of each, fragments without an end",
             HalfAnswers},
    Sequence{"yesterday", "what was heard, again and from other addresses", Yesterday},
    Sequence{"crowd", "a thousand new participants a second", Crowd},
    Sequence{"unknown_senders", "a thousand samples a second, each of another participant", UnknownSenders},
    Sequence{"requests_for_all", "asks each node for all announcements and cards, without end",
             RequestsForAll},
    Sequence{"endless_endpoints", "one participant, a hundred new endpoints a second", EndlessEndpoints},
    Sequence{"mix", "a second of each, in an order of its own", Mix}};

void Mix(Turn &turn)
{
    constexpr std::uint64_t turns = 100;
    std::mt19937_64 order(turn.Number / turns);
    All[order() % (All.size() - 1)].Play(turn);
}

}  // namespace

std::span<const Sequence> Strangers()
{
    return All;
}

}  // namespace Opponent
