#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace Rabit
{

// Lists the first six items for lines that people read, such as "`A`, `B`". `name(item)` returns the name
// of an item; without it the items are names.
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
