// Values of `rabit post` and `rabit send`: JSON for a type with a member of every kind.
#include "EveryKind.h"

int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    const auto encoded = Fuzz::EveryKind().FromJson(Fuzz::TextOf(data, size));
    Fuzz::Require(encoded.Sample.has_value() == encoded.Reason.empty());
    if (!encoded.Sample)
    {
        return 0;
    }
    if (const auto json = Fuzz::EveryKind().ToJson(*encoded.Sample))
    {
        const auto again = Fuzz::EveryKind().FromJson(*json);
        Fuzz::Require(again.Sample.has_value());
        // The sign and the payload of a NaN are lost; all else is the same.
        Fuzz::Require(json->find("NaN") != json->npos || again.Sample == encoded.Sample);
    }
    return 0;
}
