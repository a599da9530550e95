// rabit check: configurations of a fleet, against each other and against their budgets of the air. Joins no
// network.
#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "AirPlan.h"
#include "CheckedFiles.h"
#include "Command.h"
#include "FleetCheck.h"
#include "IdlFiles.h"
#include "SafeText.h"
#include "Table.h"

namespace Rabit::Tool
{
namespace CheckParts
{
namespace
{

struct Options
{
    std::vector<std::string> Files;
    std::vector<std::string> Idl;
    std::vector<std::string> Rates;
    std::vector<std::string> Sizes;
    bool Json = false;
    bool Verbose = false;
};

double Number(const std::optional<double> &number)
{
    return number.value_or(std::numeric_limits<double>::quiet_NaN());
}

// Parses `Pose=10`; throws CLI::ValidationError.
Stated StatedIn(const std::vector<std::string> &list, const std::string &option)
{
    Stated stated;
    for (const std::string &text : list)
    {
        const std::size_t equals = text.find('=');
        double number = -1.0;
        if (equals == std::string::npos || equals == 0 ||
            !CLI::detail::lexical_cast(text.substr(equals + 1), number) || !(number >= 0.0 && number <= 1e9))
        {
            throw CLI::ValidationError(option, "`" + text + "`; expected NAME=NUMBER or NODE/NAME=NUMBER");
        }
        stated.Add(text.substr(0, equals), number);
    }
    return stated;
}

void CheckArguments(const Options &options)
{
    static_cast<void>(StatedIn(options.Rates, "--rate"));
    static_cast<void>(StatedIn(options.Sizes, "--size"));
    for (const std::string &file : options.Files)
    {
        if (const std::string why = CLI::ExistingFile(CheckedFiles::Parse(file).File); !why.empty())
        {
            throw CLI::ValidationError("FILE", why);
        }
    }
}

bool ShowFindings(const std::vector<FleetCheck::Finding> &findings, bool json)
{
    bool isRead = true;
    for (const FleetCheck::Finding &finding : findings)
    {
        isRead = isRead && (json ? Output::Object(Json{{finding.IsProblem ? "problem" : "note", finding.Text},
                                                       {"file", finding.File},
                                                       {"line", finding.Line},
                                                       {"nodes", finding.Nodes}})
                                 : Output::Line(SafeText(FleetCheck::LineOf(finding))));
    }
    return isRead;
}

bool ShowJson(const AirPlan &plan)
{
    Json items = Json::array();
    for (const AirItem &item : plan.Items)
    {
        items.push_back(Json{{"what", item.What},
                             {"bytes", item.SizeKnown ? Json(item.Bytes) : Json(nullptr)},
                             {"rate_hz", Number(item.Rate)},
                             {"copies", item.Copies},
                             {"bytes_per_s", item.BytesPerSecond()}});
    }
    return Output::Object(Json{{"node", plan.Config->Node},
                               {"path", plan.Path()},
                               {"file", plan.Config->File},
                               {"air_bytes_per_s", plan.BytesPerSecond()},
                               {"budget_bytes_per_s", Number(plan.Config->Radio.Budget)},
                               {"not_known", plan.NotKnown()},
                               {"items", items}});
}

// Returns `rate and size of Findings Health, rate of Pose`.
std::string NotKnown(const AirPlan &plan)
{
    std::map<std::string, std::string> names;
    for (const std::string &entry : plan.NotKnown())
    {
        const std::size_t name = entry.find(" of ") + 4;
        names[entry.substr(0, name)] +=
            (names[entry.substr(0, name)].empty() ? "" : " ") + entry.substr(name);
    }
    std::string text;
    for (const auto &[what, of] : names)
    {
        text += (text.empty() ? "" : ", ") + what + of;
    }
    return text.empty() ? "-" : text;
}

// Returns `uav1`, or `uav1 by modem`.
std::string LabelOf(const AirPlan &plan)
{
    return plan.Config->Node + (plan.Path().empty() ? "" : " by " + plan.Path());
}

// True for the plan that holds while all paths work. The later ones carry all only if the better ones fail.
bool IsBestPath(const AirPlan &plan, const std::vector<AirPlan> &plans)
{
    const auto first =
        std::find_if(plans.begin(), plans.end(),
                     [&plan](const AirPlan &one) { return one.Config->Node == plan.Config->Node; });
    return &*first == &plan;
}

std::vector<std::vector<std::string>> Summary(const std::vector<AirPlan> &plans)
{
    std::vector<std::vector<std::string>> rows{{"NODE", "ON THE AIR", "BUDGET", "OF IT", "NOT KNOWN"}};
    double sum = 0.0;
    for (const AirPlan &plan : plans)
    {
        const double budget = Number(plan.Config->Radio.Budget);
        sum += IsBestPath(plan, plans) ? plan.BytesPerSecond() : 0.0;
        rows.push_back({LabelOf(plan), NumberText(plan.BytesPerSecond(), 0, " B/s"),
                        NumberText(budget, 0, " B/s"),
                        NumberText(100.0 * plan.BytesPerSecond() / budget, 0, " %"), NotKnown(plan)});
    }
    if (rows.size() > 2)
    {
        rows.push_back({"in all", NumberText(sum, 0, " B/s")});
    }
    return rows;
}

std::vector<std::vector<std::string>> Details(const std::vector<AirPlan> &plans)
{
    std::vector<std::vector<std::string>> rows{{"NODE", "WHAT", "EACH", "RATE", "COPIES", "ON THE AIR"}};
    for (const AirPlan &plan : plans)
    {
        for (const AirItem &item : plan.Items)
        {
            rows.push_back({LabelOf(plan), item.What,
                            NumberText(item.Bytes, 0, item.SizeKnown ? " B" : " B and more"),
                            NumberText(Number(item.Rate), 2, " Hz"), std::to_string(item.Copies),
                            NumberText(item.Rate ? item.BytesPerSecond() : Number({}), 0, " B/s")});
        }
    }
    return rows;
}

// Says which name of --rate or --size is no message, queue or type of the fleet; empty: all are.
std::string UnknownName(const Options &options, const std::vector<GatewayConfig> &fleet)
{
    for (const auto &[option, texts, names] : {std::tuple("--rate", &options.Rates, NamesIn(fleet, false)),
                                               std::tuple("--size", &options.Sizes, NamesIn(fleet, true))})
    {
        for (const std::string &text : *texts)
        {
            std::string name = text.substr(0, text.find('='));
            if (!IsAmong(names, name))
            {
                name.erase(0, name.find('/') == std::string::npos ? 0 : name.find('/') + 1);
                return std::string(option) + " " + text + ": no node has a `" + name + "`" +
                       NearestWordHint(name, names);
            }
        }
    }
    return "";
}

int Run(const Options &options)
{
    const IdlFiles types(options.Idl);
    std::vector<FleetCheck::Finding> findings;
    std::vector<CheckedFiles::Argument> arguments;
    for (const std::string &file : options.Files)
    {
        arguments.push_back(CheckedFiles::Parse(file));
    }
    const std::vector<GatewayConfig> fleet = CheckedFiles::Load(arguments, types, findings);
    const bool allGood = findings.empty();
    AirPlanInput input;
    input.Rates = StatedIn(options.Rates, "--rate");
    input.Sizes = StatedIn(options.Sizes, "--size");
    input.SizeOfType = [&types](const std::string &name)
    {
        const ParsedType parsed = types.Find(name);
        return parsed.Type ? parsed.Type->FixedSize() : std::nullopt;
    };
    // If a file could not be read, the offers of its node are unknown, so the fleet is not checked.
    if (allGood)
    {
        findings = FleetCheck::FindingsOf(fleet);
    }
    if (const std::string unknown = allGood ? UnknownName(options, fleet) : ""; !unknown.empty())
    {
        Output::Talk(unknown);
        return Usage;
    }
    const std::vector<GatewayConfig> paths = EachPathOf(fleet);
    const std::vector<AirPlan> plans = AirPlansOf(paths, input);
    for (const AirPlan &plan : plans)
    {
        if (const std::string why = WhyAboveBudget(plan); !why.empty())
        {
            FleetCheck::Add(findings, {.File = plan.Config->File,
                                       .Line = FleetCheck::LineIn(*plan.Config, "radio.budget"),
                                       .Nodes = {plan.Config->Node},
                                       .Text = why,
                                       .IsProblem = IsBestPath(plan, plans)});
        }
        for (const std::string &large : LargerThanASecond(plan))
        {
            FleetCheck::Add(findings, {.File = plan.Config->File,
                                       .Line = FleetCheck::LineIn(*plan.Config, "radio.budget"),
                                       .Nodes = {plan.Config->Node},
                                       .Text = large,
                                       .IsProblem = false});
        }
    }
    for (const GatewayConfig &config : fleet)
    {
        if (const int line = FleetCheck::LineIn(config, "parameters"); line != 0)
        {
            FleetCheck::Add(findings, {.File = config.File,
                                       .Line = line,
                                       .Nodes = {config.Node},
                                       .Text = "parameters are not looked at: the program itself checks them",
                                       .IsProblem = false});
        }
    }
    bool isRead = ShowFindings(findings, options.Json);
    if (options.Json)
    {
        for (const AirPlan &plan : plans)
        {
            isRead = isRead && ShowJson(plan);
        }
    }
    else if (!plans.empty())
    {
        for (const std::string &line : TableLines(options.Verbose ? Details(plans) : Summary(plans)))
        {
            isRead = isRead && Output::Line(SafeText(line));
        }
    }
    if (!allGood && fleet.size() > 1)
    {
        Output::Talk("the files are not compared with each other until each is good alone");
    }
    const bool isGood = std::none_of(findings.begin(), findings.end(),
                                     [](const FleetCheck::Finding &finding) { return finding.IsProblem; });
    return isGood || !isRead ? Good : ProblemFound;
}

}  // namespace
}  // namespace CheckParts

void AddCheckCommand(CLI::App &app, Chosen &chosen)
{
    using namespace CheckParts;
    const auto [command, options] = AddCommand<Options>(
        app, chosen, "check",
        "What is wrong with configurations, alone and together, and what they put on the air", &Run,
        &CheckArguments);
    command
        ->add_option("FILE", options->Files,
                     "Configurations of all nodes of a fleet; uav1,uav2=uav.yaml: of several nodes")
        ->required();
    command->add_option(
        "--rate", options->Rates,
        "NAME=HZ or NODE/NAME=HZ: how often a message is posted, or sent to each queue of that name");
    command->add_option("--size", options->Sizes, "NAME=BYTES, of a message, a queue or a type: its CDR");
    command->add_option("--idl", options->Idl, "IDL file with the types: which there are, and how large");
    command->add_flag("--json", options->Json, "One JSON object a line");
    command->add_flag("-v,--verbose", options->Verbose, "Each thing that goes on the air");
    AddExamples(*command, {"rabit check uav.yaml", "rabit check uav1,uav2=uav.yaml ground.yaml",
                           "rabit check uav.yaml ground.yaml --idl uav.idl --rate Pose=10"});
}

}  // namespace Rabit::Tool
