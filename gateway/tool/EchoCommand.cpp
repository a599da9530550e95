// rabit echo: the values of a message, as they come.
#include <limits>
#include <map>
#include <optional>

#include <rabit/idl/NearestWord.h>
#include "Command.h"
#include "FleetSession.h"
#include "JsonText.h"
#include "Samples.h"
#include "Table.h"

namespace Rabit::Tool
{
namespace EchoParts
{
namespace
{

struct Options
{
    CommonOptions Common;
    std::string What;
    ForeignOptions Foreign;
    std::string Field;
    bool Once = false;
    double Rate = 0.0;
};

struct Found
{
    std::optional<Json> Value;
    std::string Reason;
};

// Follows a path as `a.b.0`: members by name, elements by number.
Found Follow(const std::string &path, Json value)
{
    std::size_t begin = 0;
    while (begin <= path.size())
    {
        const std::size_t end = std::min(path.find('.', begin), path.size());
        const std::string step = path.substr(begin, end - begin);
        const std::string before = path.substr(0, begin == 0 ? 0 : begin - 1);
        if (value.is_array())
        {
            const bool isNumber = !step.empty() && step.size() < 10 &&
                                  step.find_first_not_of("0123456789") == std::string::npos;
            const std::size_t index = isNumber ? std::stoul(step) : std::numeric_limits<std::size_t>::max();
            if (index >= value.size())
            {
                return {{},
                        "`" + before + "` has " + std::to_string(value.size()) + " elements, and no `" +
                            step + "`"};
            }
            value = Json(value[index]);
        }
        else if (value.is_object() && value.contains(step))
        {
            value = Json(value[step]);
        }
        else
        {
            std::vector<std::string> names;
            if (value.is_object())
            {
                for (const auto &[name, member] : value.items())
                {
                    names.push_back(name);
                }
            }
            return {{}, "there is no `" + path.substr(0, end) + "`" + NearestWordHint(step, names)};
        }
        begin = end + 1;
    }
    return {std::move(value), ""};
}

class Printer
{
public:
    Printer(const Options &options, const Samples &samples) : _options(options), _samples(samples) {}

    // Returns false if the program should end, with Code.
    bool Print(const Sample &sample)
    {
        if (_options.Rate > 0.0)
        {
            const auto last = _printed.find(sample.Node);
            if (last != _printed.end() && sample.At - last->second < 1.0 / _options.Rate)
            {
                return true;
            }
            _printed[sample.Node] = sample.At;
        }
        return _options.Field.empty() && !_options.Common.Json ? PrintText(sample) : PrintJson(sample);
    }

    int Code = Good;

private:
    bool PrintText(const Sample &sample)
    {
        const auto text = _samples.Type().ToText(sample.Bytes);
        return Output::Line((sample.Node.empty() ? "" : sample.Node + "/") + _samples.Message() + "  age " +
                            NumberText(sample.Age, 3, " s  ") + text.value_or("(too large to show)"));
    }

    bool PrintJson(const Sample &sample)
    {
        const auto text = _samples.Type().ToJson(
            sample.Bytes, _options.Common.Json ? DynamicType::Wide::Text : DynamicType::Wide::Number);
        Json value = text ? Json::parse(*text, nullptr, false) : Json(nullptr);
        if (!_options.Field.empty())
        {
            Found found = Follow(_options.Field, std::move(value));
            if (!found.Value)
            {
                Output::Talk(found.Reason);
                Code = ProblemFound;
                return false;
            }
            value = std::move(*found.Value);
        }
        if (!_options.Common.Json)
        {
            return Output::Line(JsonText(value));
        }
        return Output::Object({{"node", sample.Node.empty() ? Json(nullptr) : Json(sample.Node)},
                               {"message", _samples.Message()},
                               {"type", _samples.Type().Name()},
                               {"age_s", sample.Age},
                               {"posted_gps_s", sample.Stamp},
                               {"value", std::move(value)}});
    }

    const Options &_options;
    const Samples &_samples;
    std::map<std::string, double> _printed;
};

int Show(const Options &options, FleetSession &session, Samples &samples, Wakeup &wakeup)
{
    Printer printer(options, samples);
    const double patience = session.Seconds() + options.Common.Wait;
    bool any = false;
    while (!wakeup.IsInterrupted())
    {
        const std::vector<Sample> taken = samples.Take(any ? session.Seconds() + 1.0 : patience);
        for (const Sample &sample : taken)
        {
            if (!printer.Print(sample) || options.Once)
            {
                return printer.Code;
            }
        }
        if (!any && taken.empty() && !wakeup.IsInterrupted() && session.Seconds() >= patience)
        {
            session.TellProblems();
            Output::Talk("nothing has come yet");
            if (options.Once)
            {
                return ProblemFound;
            }
            any = true;
        }
        any = any || !taken.empty();
    }
    if (samples.Missed() > 0)
    {
        Output::Talk(std::to_string(samples.Missed()) + " values came faster than they were written");
    }
    return Good;
}

int Run(const Options &options, Wakeup &wakeup)
{
    return ListenTo(options.Common, options.What, options.Foreign, wakeup,
                    [&](FleetSession &session, Samples &samples)
                    { return Show(options, session, samples, wakeup); });
}

}  // namespace
}  // namespace EchoParts

void AddEchoCommand(CLI::App &app, Chosen &chosen)
{
    using namespace EchoParts;
    const auto [command, options] =
        AddCommand<Options>(app, chosen, "echo", "The values of a message, as they come", &Run);
    command->add_option("MESSAGE", options->What, "uav1/Pose; *, ? stand for any node; Pose: of all nodes")
        ->required();
    AddCommonOptions(*command, options->Common, 5.0);
    AddForeignOptions(*command, options->Foreign);
    command->add_option("--field", options->Field, "Only that part of the value, as a.b or a.0");
    command->add_flag("--once", options->Once, "One value, then end");
    command->add_option("--rate", options->Rate, "So many a second of each node at most")->check(AboveZero());
    AddExamples(*command,
                {"rabit echo uav1/Pose --once", "rabit echo 'uav*/Pose' --field altitude_m --rate 1",
                 "rabit echo /chatter --type std_msgs/msg/String --idl /opt/ros/humble/share"});
}

}  // namespace Rabit::Tool
