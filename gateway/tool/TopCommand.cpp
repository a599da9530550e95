// rabit top: which node uses the channel, and for what.
#include <rabit/gateway/ClassRates.h>

#include <boost/algorithm/string/case_conv.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "AirText.h"
#include "Command.h"
#include "FleetSession.h"
#include "NodeAnswers.h"
#include "OneNode.h"
#include "SafeText.h"
#include "Table.h"

namespace Rabit::Tool
{
namespace TopParts
{
namespace
{

struct Options
{
    CommonOptions Common;
    double Every = 2.0;
    bool Once = false;
};

// A node, and what it sends; empty: it has not answered.
using Row = std::pair<std::string, std::optional<Gateway::AirStatus>>;

std::string Number(double bytesPerSecond, bool zeroIsNone = false)
{
    return zeroIsNone && bytesPerSecond <= 0.0 ? "-" : NumberText(bytesPerSecond, 0);
}

std::vector<std::string> CellsOf(const Row &row)
{
    std::vector<std::string> cells{SafeText(row.first)};
    if (!row.second)
    {
        cells.resize(5 + ClassRates.size(), "?");
        return cells;
    }
    const Gateway::AirStatus &air = *row.second;
    cells.push_back(Number(air.used));
    cells.push_back(Number(air.budget, true));
    cells.push_back(Number(air.capacity, true));
    cells.push_back(Number(air.discovery));
    for (const auto &[name, rate] : ClassRates)
    {
        cells.push_back(Number(air.*rate));
    }
    return cells;
}

Json JsonOf(const Row &row)
{
    Json object{{"node", row.first}};
    const std::optional<Gateway::AirStatus> &air = row.second;
    const auto add = [&](const char *name, double Gateway::AirStatus::*member, bool zeroIsNone)
    {
        object[name] =
            !air || (zeroIsNone && air.value().*member <= 0.0) ? Json(nullptr) : Json(air.value().*member);
    };
    add("bytes_per_s", &Gateway::AirStatus::used, false);
    add("budget_bytes_per_s", &Gateway::AirStatus::budget, true);
    add("capacity_bytes_per_s", &Gateway::AirStatus::capacity, true);
    add("discovery", &Gateway::AirStatus::discovery, false);
    for (const auto &[name, rate] : ClassRates)
    {
        add(name, rate, false);
    }
    return object;
}

bool Show(std::vector<Row> rows, bool json)
{
    const auto used = [](const Row &row)
    { return row.second ? row.second->used : -std::numeric_limits<double>::infinity(); };
    std::stable_sort(rows.begin(), rows.end(),
                     [&used](const Row &one, const Row &other) { return used(one) > used(other); });
    if (json)
    {
        return std::all_of(rows.begin(), rows.end(),
                           [](const Row &row) { return Output::Object(JsonOf(row)); });
    }
    std::vector<std::vector<std::string>> cells{{"NODE", "B/s", "BUDGET", "CAPACITY", "DISCOVERY"}};
    for (const auto &[name, rate] : ClassRates)
    {
        cells[0].push_back(boost::algorithm::to_upper_copy(std::string(name)));
    }
    double all = 0.0;
    for (const Row &row : rows)
    {
        cells.push_back(CellsOf(row));
        all += row.second ? row.second->used : 0.0;
    }
    cells.push_back({"in all", Number(all)});
    return Output::Lines(TableLines(cells));
}

// Asks all live nodes, and waits for their answers, at most until `until`, in seconds from the start of the
// session. This program has a row, too.
std::vector<Row> Ask(FleetSession &session, double until)
{
    std::vector<Row> rows;
    for (const auto &[name, answer] : AnswersOfAll(session, FleetExplorer::Report::Air, until))
    {
        rows.emplace_back(name, answer ? AirStatusOf(*answer) : std::nullopt);
    }
    const Gateway::Fleet own = session.Fleet();
    rows.emplace_back(own.node, own.air);
    return rows;
}

int Run(const Options &options, Wakeup &wakeup)
{
    FleetSession session(ConfigWithoutOffers(options.Common), options.Common, wakeup);
    session.WaitUntil(options.Common.IsWaitGiven ? options.Common.Wait : 0.0);
    session.WaitForEverybody([] { return true; });
    if (!session.IsAnybodyThere())
    {
        return session.NobodyThere();
    }
    for (;;)
    {
        const double end = session.Seconds() + std::max(options.Every, 2.0);
        const std::vector<Row> rows = Ask(session, end);
        if (wakeup.IsInterrupted())
        {
            return options.Once ? Interrupted : Good;  // the last whole table stays
        }
        if (!options.Once && !options.Common.Json)
        {
            Output::BeginScreen();
        }
        if (!Show(rows, options.Common.Json) || options.Once)
        {
            const bool isWhole =
                std::all_of(rows.begin(), rows.end(), [](const Row &row) { return row.second.has_value(); });
            return isWhole || !options.Once ? Good : ProblemFound;
        }
        session.WaitUntil(end);
    }
}

}  // namespace
}  // namespace TopParts

void AddTopCommand(CLI::App &app, Chosen &chosen)
{
    using namespace TopParts;
    const auto [command, options] =
        AddCommand<Options>(app, chosen, "top", "Which node sends how much, and of which class", &Run);
    AddCommonOptions(*command, options->Common, 3.0);
    command->add_option("--every", options->Every, "Seconds from one table to the next (default: 2)")
        ->check(CLI::Range(2.0, 3600.0));
    command->add_flag("--once", options->Once, "One table instead of one after the other until Ctrl-C");
    AddExamples(*command, {"rabit top", "rabit top --once --wait 10", "rabit top --every 10 --json"});
}

}  // namespace Rabit::Tool
