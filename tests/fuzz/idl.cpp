// IDL texts of types, as unauthenticated peers and recordings give them.
#include <rabit/dynamic/DynamicType.h>

#include "Input.h"

// The name of the type, a line feed, and the text.
int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
{
    const std::string_view all = Fuzz::TextOf(data, size);
    const std::size_t end = std::min(all.find('\n'), all.size());
    const auto parsed =
        Rabit::DynamicType::Parse(all.substr(std::min(end + 1, all.size())), all.substr(0, end));
    Fuzz::Require((parsed.Type == nullptr) != parsed.Reason.empty());
    if (parsed.Type)
    {
        Fuzz::Require(parsed.Type->Normalized(parsed.Type->DefaultSample()).has_value());
    }
    return 0;
}
