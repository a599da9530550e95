#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "gateway.idl.h"
#include "wire/Announcements.h"
#include "wire/BeatFormat.h"
#include "wire/BeatNews.h"

namespace Rabit
{

// Returns a beat of a node whose source clock shows `source`. Its next beat is due half a second later.
inline Gateway::Beat BeatAt(std::chrono::nanoseconds source)
{
    Gateway::Beat beat;
    beat.format = BeatFormat::Present;
    beat.next_ms = 500;
    beat.source_ns = source.count();
    return beat;
}

// Makes the beat refer to this announcement and carry all of it.
inline void Announce(Gateway::Beat &beat, const Gateway::Announcement &announcement)
{
    const std::vector<std::uint8_t> bytes = Announcements::Encode(announcement);
    beat.offers = Announcements::DigestOf(bytes);
    Gateway::AnnouncementPart &part = NewsOf(beat).parts.emplace_back();
    part.of = static_cast<std::uint16_t>(bytes.size());
    part.bytes = bytes;
}

}  // namespace Rabit
