#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace Rabit
{

// Lists the first six items for lines that people read, such as "`A`, `B`" or, of eight items, "`A`, `B`,
// `C`, `D`, `E`, `F` and 2 more". The text is empty if there are no items. `items` has size() and operator[],
// as a vector does. `name(item)` returns the name of an item; without it the items are names. The names are
// taken as they are: the caller makes names from the network printable (Printable.h).
template <typename Items, typename Name = std::identity>
std::string ListedNames(const Items &items, Name name = {})
{
    constexpr std::size_t most = 6;
    std::string text;
    for (std::size_t i = 0; i < items.size() && i < most; ++i)
    {
        text += (i > 0 ? ", `" : "`") + name(items[i]) + "`";
    }
    if (items.size() > most)
    {
        text += " and " + std::to_string(items.size() - most) + " more";
    }
    return text;
}

}  // namespace Rabit
