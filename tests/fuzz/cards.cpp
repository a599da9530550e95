// Messages of cards, packed cards, and what a node does with them.
#include "Input.h"
#include "rtps/CardMessage.h"
#include "rtps/Meeting.h"
#include "rtps/PackedCard.h"

// Datagrams, each behind its size and the seconds since the one before.
int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    if (const auto card = Rabit::Rtps::UnpackCard({data, size}))
    {
        Fuzz::Require(card->size() <= Rabit::Rtps::LargestUnpackedCard);
    }
    Fuzz::Input input(data, size);
    Rabit::Rtps::Meeting meeting({.Period = std::chrono::seconds(1), .Memory = std::chrono::minutes(1)});
    Rabit::Rtps::Meeting::TimePoint now{std::chrono::hours(1)};
    while (!input.IsEmpty())
    {
        now += std::chrono::seconds(input.Byte() % 8);
        meeting.Received(input.Part(), {127, 0, 0, 1}, false, now);
        meeting.TakeLocal(now);
        meeting.TakeForNetwork(now);
    }
    return 0;
}
