// Sound messages of the opponent: participants, endpoints and cards that it invents.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "Sequence.h"

namespace Opponent
{

// A participant that does not exist. Numbers give names that differ.
GuidPrefix Invented(std::uint64_t number);

struct Place
{
    // Where it says that it is reached; last byte of the address 10.77.0.x.
    std::uint8_t Host = 200;
    std::uint16_t Port = 7411;
};

Bytes ParticipantData(const GuidPrefix &name, const Place &place);
// A reader or a writer of a topic, with so many bytes of user data.
Bytes EndpointData(const GuidPrefix &name, EntityId entity, const char *topic, const char *type,
                   std::size_t userData = 0);

// Submessages with data of discovery.
Bytes ParticipantSaid(const GuidPrefix &name, const Place &place, std::int64_t number = 1);
Bytes EndpointSaid(EntityId writer, const Bytes &data, std::int64_t number);

// Messages.
Bytes Announcement(const GuidPrefix &name, const Place &place = {}, std::int64_t number = 1);
Bytes Goodbye(const GuidPrefix &name, std::int64_t number = 2);
Bytes Heartbeat(const GuidPrefix &name, EntityId writer, std::int64_t first, std::int64_t last,
                std::uint32_t count);

// The topics of each node, which everybody knows.
constexpr const char *BeatTopic = "rabit/Beat";
constexpr const char *BeatType = "Rabit::Gateway::Beat";

// The messages that bring a card: it consists of these submessages.
std::vector<Bytes> CardOf(const GuidPrefix &name, std::initializer_list<Bytes> submessages, TimePoint now);

}  // namespace Opponent
