// Announcements of what nodes publish and accept.
#include "wire/Announcements.h"
#include "Input.h"

int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    const std::vector<std::uint8_t> bytes(data, data + size);
    const auto announcement = Rabit::Announcements::Decode(bytes);
    if (announcement)
    {
        Fuzz::Require(Rabit::Announcements::IsPlausible(*announcement));
        const auto again = Rabit::Announcements::Encode(*announcement);
        const auto same = Rabit::Announcements::Decode(again);
        Fuzz::Require(same.has_value() && Rabit::Announcements::Encode(*same) == again);
        Rabit::Announcements::StatesIn(*announcement);
    }
    return 0;
}
