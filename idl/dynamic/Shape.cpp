#include <rabit/dynamic/Shape.h>

#include <algorithm>

namespace Rabit::Dynamic
{

const NamedNumber *EnumeratorOf(const Shape &shape, std::uint64_t value)
{
    // Most enums start at 0 and have no gaps.
    if (value < shape.Names.size() && shape.Names[value].Number == value)
    {
        return &shape.Names[value];
    }
    const auto found = std::lower_bound(shape.Names.begin(), shape.Names.end(), value,
                                        [](const NamedNumber &a, std::uint64_t b) { return a.Number < b; });
    return found != shape.Names.end() && found->Number == value ? &*found : nullptr;
}

int CaseOf(const Shape &shape, std::int64_t label)
{
    const auto found = std::lower_bound(shape.Labels.begin(), shape.Labels.end(), label,
                                        [](const auto &a, std::int64_t b) { return a.first < b; });
    return found != shape.Labels.end() && found->first == label ? found->second : shape.OtherCase;
}

}  // namespace Rabit::Dynamic
