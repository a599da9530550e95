#include "AreaLines.h"

#include <algorithm>

namespace Ground
{
namespace
{
constexpr std::size_t MostNamed = 4;

std::string NamesOf(const AreaStatus &area, AreaProgress progress)
{
    const std::size_t count = CountOf(area, progress);
    if (count > MostNamed)
        return std::to_string(count) + " aircraft";
    std::string names;
    for (const AreaAnswer &answer : area.answers)
        if (answer.progress == progress)
            names += (names.empty() ? "" : ", ") + Printable(answer.node, LongestName);
    return names;
}
}  // namespace

std::size_t CountOf(const AreaStatus &area, AreaProgress progress)
{
    return static_cast<std::size_t>(std::count_if(area.answers.begin(), area.answers.end(),
                                                  [progress](const AreaAnswer &answer)
                                                  { return answer.progress == progress; }));
}

bool IsFlownByAll(const AreaStatus &area)
{
    return CountOf(area, AreaProgress::AREA_FLOWN) == area.answers.size();
}

std::string AreaText(const AreaStatus &area)
{
    std::string text = std::to_string(CountOf(area, AreaProgress::AREA_FLOWN)) + " of " +
                       std::to_string(area.answers.size()) + " fly area " + std::to_string(area.area.number);
    const auto add = [&](const std::string &what, AreaProgress progress)
    {
        const std::string names = NamesOf(area, progress);
        if (!names.empty())
            text += "; " + what + " " + names;
    };
    add("declined by", AreaProgress::AREA_DECLINED);
    add("not answered by", AreaProgress::AREA_SENT);
    add("replaced at", AreaProgress::AREA_REPLACED);
    return text;
}

std::vector<TableLine> AreaTableLines(const AreaList &areas)
{
    if (areas.items.empty())
        return {};
    const AreaStatus &wanted = areas.items.back();
    return {{"Search area: " + AreaText(wanted), IsFlownByAll(wanted) ? Emphasis::None : Emphasis::Warning}};
}

}  // namespace Ground
