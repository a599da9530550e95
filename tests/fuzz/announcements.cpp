// Announcements of what nodes publish and accept.
#include "wire/Announcements.h"
#include "Input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
    const std::vector<std::uint8_t> bytes(data, data + size);
    const auto announcement = Rabit::Announcements::Decode(bytes);
    if (announcement)
    {
        Fuzz::Require(Rabit::Announcements::IsPlausible(*announcement));
        Fuzz::Require(Rabit::Announcements::Decode(Rabit::Announcements::Encode(*announcement)).has_value());
        Rabit::Announcements::StatesIn(*announcement);
    }
    return 0;
}
