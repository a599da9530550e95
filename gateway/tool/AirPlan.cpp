#include "AirPlan.h"

#include <rabit/gateway/AirCost.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/PresenceTraffic.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <numeric>

namespace Rabit::Tool
{
namespace
{

// Nearly the largest measured announcement of a participant, in bytes on the air (docs/how_to/radio.md).
constexpr double Announcement = 510.0;
// Bytes of the frame around a queue message, and of an acknowledgement; both are samples of the gateways
// (docs/how_to/radio.md).
constexpr std::size_t LinkFrame = 36;

double Seconds(std::chrono::nanoseconds time)
{
    return std::chrono::duration<double>(time).count();
}

class Planner
{
public:
    Planner(const GatewayConfig &config, const std::vector<GatewayConfig> &fleet, const AirPlanInput &input)
        : _config(config), _input(input), _cost(config.MaxDatagram)
    {
        for (const GatewayConfig &other : fleet)
        {
            const bool isKnown =
                std::any_of(_others.begin(), _others.end(),
                            [&other](const GatewayConfig *one) { return one->Node == other.Node; });
            if (other.Domain == config.Domain && other.Node != config.Node && !isKnown)
            {
                _others.push_back(&other);
            }
        }
    }

    AirPlan Plan()
    {
        _plan.Config = &_config;
        AddPresence();
        for (const PublishRule &rule : _config.Publish)
        {
            AddMessage(rule);
        }
        for (const ForeignRule &rule : _config.Foreign)
        {
            AddForeign(rule);
        }
        for (const GatewayConfig *other : _others)
        {
            AddSent(*other);
            AddAcknowledged(*other);
        }
        AddUnstatedQueues();
        return std::move(_plan);
    }

private:
    // By multicast one copy serves all readers. Without it, or with `peers`, each reader gets a copy.
    std::size_t Copies(std::size_t readers) const
    {
        const bool once = _config.Multicast && _config.Peers.empty();
        return once ? std::min<std::size_t>(readers, 1) : readers;
    }

    void AddPresence()
    {
        const std::size_t copies = std::max<std::size_t>(1, Copies(_others.size()));
        const PresenceTraffic presence = PresenceTrafficOf(_config, copies);
        _plan.Items.push_back(
            {"beats", static_cast<double>(presence.BeatBytes), 1.0 / Seconds(presence.BeatPeriod), copies});
        _plan.Items.push_back(
            {"discovery", Announcement, 1.0 / Seconds(presence.AnnouncementPeriod), copies});
    }

    std::optional<double> SizeOf(const std::string &node, const std::string &name,
                                 const std::vector<std::string> &types) const
    {
        if (const auto stated = _input.Sizes.Of(node, name))
        {
            return stated;
        }
        // Of several types, the largest counts.
        double largest = 0.0;
        for (const std::string &type : types)
        {
            const auto stated = _input.Sizes.Of(node, type);
            const auto fixed = _input.SizeOfType ? _input.SizeOfType(type) : std::nullopt;
            if (!stated && !fixed)
            {
                return std::nullopt;
            }
            largest = std::max(largest, stated ? *stated : static_cast<double>(*fixed));
        }
        return largest;
    }

    double OnAir(double body, bool directed) const
    {
        return static_cast<double>(_cost.Of(static_cast<std::size_t>(std::llround(body)),
                                            {.Destinations = 1, .Directed = directed}));
    }

    void AddMessage(const PublishRule &rule)
    {
        const auto readers = static_cast<std::size_t>(std::count_if(
            _others.begin(), _others.end(),
            [&](const GatewayConfig *other)
            {
                return std::any_of(
                    other->Subscribe.begin(), other->Subscribe.end(),
                    [&](const SubscribeRule &wanted)
                    { return wanted.Message == rule.Message && MatchesAny(wanted.From, _config.Node); });
            }));
        const auto size = SizeOf(_config.Node, rule.Message, {rule.Type});
        _plan.Items.push_back({rule.Message, OnAir(size.value_or(0.0), false),
                               RateOf(rule.Message, rule.MaxRate), _others.empty() ? 1 : Copies(readers),
                               size.has_value()});
    }

    // Foreign programs are not in the files: one reader is assumed.
    void AddForeign(const ForeignRule &rule)
    {
        if (rule.Way == ForeignRule::Direction::Publish)
        {
            const auto size = SizeOf(_config.Node, rule.Local, {rule.Type});
            _plan.Items.push_back({rule.Topic, OnAir(size.value_or(0.0), false),
                                   RateOf(rule.Local, rule.MaxRate), 1, size.has_value(), rule.Local});
        }
    }

    // The stated rate, limited by the file's max_rate; 0: no limit.
    std::optional<double> RateOf(const std::string &message, double maxRate) const
    {
        const std::optional<double> stated = _input.Rates.Of(_config.Node, message);
        return maxRate > 0.0 ? std::min(stated.value_or(maxRate), maxRate) : stated;
    }

    // Rate of queue messages from `from` into `queue`; empty if none is stated, or the queue does not accept
    // them.
    static std::optional<double> Sent(const Stated &rates, const GatewayConfig &from, const AcceptRule &queue)
    {
        return MatchesAny(queue.From, from.Node) ? rates.Of(from.Node, queue.Queue) : std::nullopt;
    }

    void AddSent(const GatewayConfig &other)
    {
        for (const AcceptRule &queue : other.Accept)
        {
            if (const auto rate = Sent(_input.Rates, _config, queue))
            {
                const auto size = SizeOf(_config.Node, queue.Queue, queue.Types);
                _plan.Items.push_back({queue.Queue + " of " + other.Node,
                                       OnAir(static_cast<double>(LinkFrame) + size.value_or(0.0), true), rate,
                                       1, size.has_value()});
            }
        }
    }

    void AddAcknowledged(const GatewayConfig &other)
    {
        for (const AcceptRule &queue : _config.Accept)
        {
            if (const auto rate = Sent(_input.Rates, other, queue))
            {
                _plan.Items.push_back({"acknowledgements to " + other.Node,
                                       OnAir(static_cast<double>(LinkFrame), true), rate, 1});
            }
        }
    }

    // A node with a rule for a queue sends to it, at a rate that no file tells.
    void AddUnstatedQueues()
    {
        for (const SendRule &rule : _config.Send)
        {
            const bool isPattern = rule.Queue.find_first_of("*?") != std::string::npos;
            const bool isAdded =
                std::any_of(_plan.Items.begin(), _plan.Items.end(),
                            [&rule](const AirItem &item) { return item.What == rule.Queue; });
            if (!isPattern && !isAdded && !_input.Rates.Of(_config.Node, rule.Queue))
            {
                _plan.Items.push_back(
                    {rule.Queue, OnAir(static_cast<double>(LinkFrame), true), std::nullopt, 1, false});
            }
        }
    }

    const GatewayConfig &_config;
    const AirPlanInput &_input;
    const AirCost _cost;
    std::vector<const GatewayConfig *> _others;
    AirPlan _plan;
};

}  // namespace

void Stated::Add(const std::string &what, double number)
{
    _stated.emplace_back(what, number);
}

std::optional<double> Stated::Of(const std::string &node, const std::string &name) const
{
    for (const auto &[what, number] : _stated)
    {
        const std::size_t slash = what.find('/');
        const bool ofNode = slash != std::string::npos && MatchesPattern(what.substr(0, slash), node) &&
                            MatchesPattern(what.substr(slash + 1), name);
        if (ofNode || MatchesPattern(what, name))
        {
            return number;
        }
    }
    return std::nullopt;
}

double AirPlan::BytesPerSecond() const
{
    return std::accumulate(Items.begin(), Items.end(), 0.0,
                           [](double sum, const AirItem &item) { return sum + item.BytesPerSecond(); });
}

std::vector<std::string> AirPlan::NotKnown() const
{
    std::vector<std::string> list;
    for (const AirItem &item : Items)
    {
        // A message without readers is not sent.
        if (item.Copies > 0 && (!item.Rate || (!item.SizeKnown && *item.Rate > 0.0)))
        {
            const std::string what = !item.Rate && !item.SizeKnown ? "rate and size of "
                                     : !item.Rate                  ? "rate of "
                                                                   : "size of ";
            list.push_back(what + (item.Name.empty() ? item.What : item.Name));
        }
    }
    return list;
}

std::vector<std::string> NamesIn(const std::vector<GatewayConfig> &fleet, bool types)
{
    std::vector<std::string> names;
    const auto add = [&names, types](const std::string &name, const std::vector<std::string> &ofTypes)
    {
        names.push_back(name);
        names.insert(names.end(), ofTypes.begin(), types ? ofTypes.end() : ofTypes.begin());
    };
    for (const GatewayConfig &config : fleet)
    {
        for (const PublishRule &rule : config.Publish)
        {
            add(rule.Message, {rule.Type});
        }
        for (const AcceptRule &rule : config.Accept)
        {
            add(rule.Queue, rule.Types);
        }
        for (const SubscribeRule &rule : config.Subscribe)
        {
            add(rule.Message, {rule.Type});
        }
        for (const ForeignRule &rule : config.Foreign)
        {
            add(rule.Local, {rule.Type});
        }
        for (const SendRule &rule : config.Send)
        {
            add(rule.Queue, {});
        }
    }
    return names;
}

bool IsAmong(const std::vector<std::string> &names, const std::string &stated)
{
    const std::size_t slash = stated.find('/');
    const std::string ofNode = slash == std::string::npos ? stated : stated.substr(slash + 1);
    return std::any_of(names.begin(), names.end(),
                       [&stated, &ofNode](const std::string &one) {
                           return MatchesPattern(ofNode, one) || MatchesPattern(one, ofNode) ||
                                  MatchesPattern(stated, one);
                       });
}

std::vector<GatewayConfig> EachPathOf(const std::vector<GatewayConfig> &fleet)
{
    std::vector<GatewayConfig> paths;
    for (const GatewayConfig &config : fleet)
    {
        std::vector<GatewayConfig> ofNode = PathConfigsOf(config);
        std::for_each(ofNode.begin() + 1, ofNode.end(),
                      [](GatewayConfig &later) { later.Foreign.clear(); });  // the first path has them
        std::move(ofNode.begin(), ofNode.end(), std::back_inserter(paths));
    }
    return paths;
}

std::vector<AirPlan> AirPlansOf(const std::vector<GatewayConfig> &fleet, const AirPlanInput &input)
{
    std::vector<AirPlan> plans;
    for (const GatewayConfig &config : fleet)
    {
        plans.push_back(Planner(config, fleet, input).Plan());
    }
    return plans;
}

std::string WhyAboveBudget(const AirPlan &plan)
{
    const std::optional<double> budget = plan.Config->Radio.Budget;
    if (!budget || plan.BytesPerSecond() <= *budget)
    {
        return "";
    }
    const auto most = std::max_element(plan.Items.begin(), plan.Items.end(),
                                       [](const AirItem &one, const AirItem &other)
                                       { return one.BytesPerSecond() < other.BytesPerSecond(); });
    const auto text = [](double bytes) { return std::to_string(std::llround(bytes)) + " B/s"; };
    const std::string path = plan.Path();
    return (path.empty() ? "" : "path " + path + ": ") + "the budget is " + text(*budget) + ", and " +
           text(plan.BytesPerSecond()) + " would go on the air" + (path.empty() ? "" : " if it carries all") +
           ", most of it " + most->What + " with " + text(most->BytesPerSecond()) +
           "; a max_rate, or a larger budget";
}

std::vector<std::string> LargerThanASecond(const AirPlan &plan)
{
    std::vector<std::string> list;
    const double budget = plan.Config->Radio.Budget.value_or(0.0);
    for (const AirItem &item : plan.Items)
    {
        const double bytes = item.Bytes * static_cast<double>(item.Copies);
        if (budget > 0.0 && bytes > budget)
        {
            list.push_back("one " + item.What + " takes " + std::to_string(std::llround(bytes)) +
                           " bytes on the air, which is more than a second of the budget of " +
                           std::to_string(std::llround(budget)) + " B/s: newer ones wait meanwhile");
        }
    }
    return list;
}

}  // namespace Rabit::Tool
