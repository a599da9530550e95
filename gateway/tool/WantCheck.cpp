#include "WantCheck.h"

#include <rabit/base/ListedNames.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <set>

namespace Rabit::Tool
{
namespace
{

const PublishRule *Offered(const GatewayConfig &config, const std::string &message)
{
    const auto found = std::find_if(config.Publish.begin(), config.Publish.end(),
                                    [&message](const PublishRule &rule) { return rule.Message == message; });
    return found == config.Publish.end() ? nullptr : &*found;
}

bool IsPattern(const std::string &text)
{
    return text.find_first_of("*?") != std::string::npos;
}

bool IsEverybody(const std::vector<std::string> &patterns)
{
    return std::find(patterns.begin(), patterns.end(), "*") != patterns.end();
}

std::vector<std::string> NamesOf(const std::vector<const GatewayConfig *> &nodes)
{
    std::vector<std::string> names;
    for (const GatewayConfig *node : nodes)
    {
        names.push_back(node->Node);
    }
    return names;
}

// Number of edits (Damerau-Levenshtein, ignoring case) after which the pattern matches the name. Digits are
// not edited: they number aircraft.
std::size_t EditsToMatch(const std::string &pattern, const std::string &name)
{
    constexpr std::size_t never = 1000;
    const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
    const auto isSame = [](char a, char b)
    { return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b)); };
    std::vector<std::vector<std::size_t>> edits(pattern.size() + 1,
                                                std::vector<std::size_t>(name.size() + 1, never));
    edits[0][0] = 0;
    for (std::size_t i = 0; i <= pattern.size(); ++i)
    {
        for (std::size_t j = i == 0 ? 1 : 0; j <= name.size(); ++j)
        {
            std::size_t &least = edits[i][j];
            const char p = i > 0 ? pattern[i - 1] : '\0';
            const char n = j > 0 ? name[j - 1] : '\0';
            if (i > 0)
            {
                least = edits[i - 1][j] + (p == '*' ? 0 : isDigit(p) ? never : 1);
            }
            if (j > 0)
            {
                least = std::min(least, edits[i][j - 1] + (p == '*' ? 0 : isDigit(n) ? never : 1));
            }
            if (i > 0 && j > 0 && p != '*')
            {
                const std::size_t other = isDigit(p) || isDigit(n) ? never : 1;
                least = std::min(least, edits[i - 1][j - 1] + (p == '?' || isSame(p, n) ? 0 : other));
            }
            if (i > 1 && j > 1 && !isDigit(p) && !isDigit(n) && isSame(p, name[j - 2]) &&
                isSame(pattern[i - 2], n))
            {
                least = std::min(least, edits[i - 2][j - 2] + 1);
            }
        }
    }
    return edits[pattern.size()][name.size()];
}

// Returns a name for which the pattern is probably mistyped; null if there is none.
const std::string *NearMatch(const std::string &pattern, const std::vector<std::string> &names)
{
    const auto letters = static_cast<std::size_t>(
        std::count_if(pattern.begin(), pattern.end(), [](unsigned char c) { return std::isalpha(c) != 0; }));
    const auto near =
        std::find_if(names.begin(), names.end(),
                     [&](const std::string &name) { return EditsToMatch(pattern, name) <= letters / 3; });
    return near == names.end() ? nullptr : &*near;
}

std::vector<std::string> MessagesOf(const std::vector<const GatewayConfig *> &nodes)
{
    std::set<std::string> names;
    for (const GatewayConfig *node : nodes)
    {
        for (const PublishRule &rule : node->Publish)
        {
            names.insert(rule.Message);
        }
    }
    return {names.begin(), names.end()};
}

std::vector<std::string> QueuesOf(const std::vector<const GatewayConfig *> &nodes)
{
    std::set<std::string> names;
    for (const GatewayConfig *node : nodes)
    {
        for (const AcceptRule &rule : node->Accept)
        {
            names.insert(rule.Queue);
        }
    }
    return {names.begin(), names.end()};
}

}  // namespace

WantCheck::WantCheck(const GatewayConfig &config, const std::vector<GatewayConfig> &fleet,
                     std::vector<FleetCheck::Finding> &findings)
    : _config(config), _fleet(fleet), _findings(findings)
{
    for (const GatewayConfig &other : fleet)
    {
        if (other.Domain == config.Domain && other.Node != config.Node)
        {
            _others.push_back(&other);
        }
    }
}

void WantCheck::Run()
{
    if (_others.empty())
    {
        return;
    }
    for (const PublishRule &rule : _config.Publish)
    {
        CheckPublication(rule);
    }
    for (const SubscribeRule &rule : _config.Subscribe)
    {
        CheckSubscription(rule);
    }
    for (const AcceptRule &rule : _config.Accept)
    {
        CheckAcceptance(rule);
    }
    for (const SendRule &rule : _config.Send)
    {
        CheckSending(rule);
    }
}

void WantCheck::Fail(int line, const std::string &text)
{
    FleetCheck::Add(_findings, {.File = _config.File, .Line = line, .Nodes = {_config.Node}, .Text = text});
}

void WantCheck::TellNobody(const std::string &pattern, const std::string &what, int line, MayBe mayBe)
{
    for (const GatewayConfig &other : _fleet)
    {
        if (other.Domain != _config.Domain && MatchesPattern(pattern, other.Node))
        {
            Fail(line, what + ": " + other.Node + " is in domain " + std::to_string(other.Domain) +
                           ", this node in " + std::to_string(_config.Domain));
            return;
        }
    }
    if (IsPattern(pattern))
    {
        // The pattern may be for nodes that fly another day, but not if it is mistyped.
        const std::vector<std::string> names = NamesOf(_others);
        const std::string *const near = NearMatch(pattern, names);
        FleetCheck::Add(_findings, {.File = _config.File,
                                    .Line = line,
                                    .Nodes = {_config.Node},
                                    .Text = what + ": no other node fits `" + pattern + "`" +
                                            (near != nullptr ? "; did you mean `" + *near + "`?" : ""),
                                    .IsProblem = near != nullptr});
        return;
    }
    const std::string hint = NearestWordHint(pattern, NamesOf(_others));
    if (mayBe == MayBe::Tool && !hint.starts_with("; did you mean"))
    {
        FleetCheck::Add(_findings, {.File = _config.File,
                                    .Line = line,
                                    .Nodes = {_config.Node},
                                    .Text = what + ": none of the files is of `" + pattern +
                                            "`; a tool of that name may send (`rabit send --node`)",
                                    .IsProblem = false});
        return;
    }
    Fail(line, what + ": no other node is called `" + pattern + "`" + hint);
}

// Returns the other nodes that match, and reports patterns without a match: every plain name must match, and
// at least one of several patterns.
WantCheck::Nodes WantCheck::Meant(const std::vector<std::string> &patterns, const std::string &what, int line,
                                  MayBe mayBe)
{
    Nodes meant;
    std::copy_if(_others.begin(), _others.end(), std::back_inserter(meant),
                 [&patterns](const GatewayConfig *other) { return MatchesAny(patterns, other->Node); });
    for (const std::string &pattern : patterns)
    {
        const bool isThere = pattern == _config.Node ||  // in a file that serves several nodes
                             std::any_of(meant.begin(), meant.end(),
                                         [&pattern](const GatewayConfig *other)
                                         { return MatchesPattern(pattern, other->Node); });
        if (!isThere && (meant.empty() || !IsPattern(pattern)))
        {
            TellNobody(pattern, what, line, mayBe);
        }
        if (meant.empty())
        {
            break;
        }
    }
    return meant;
}

// A DDS topic has one type for all publishers.
void WantCheck::CheckPublication(const PublishRule &rule)
{
    for (const GatewayConfig *other : _others)
    {
        const PublishRule *published = Offered(*other, rule.Message);
        // Reported once, for the node that comes later in the fleet.
        if (published != nullptr && published->Type != rule.Type && other < &_config)
        {
            Fail(rule.Line, "`" + rule.Message + "` is published as `" + rule.Type + "`, by " + other->Node +
                                " as `" + published->Type + "`");
            return;
        }
    }
}

void WantCheck::CheckSubscription(const SubscribeRule &rule)
{
    const std::string what = "subscribe " + rule.Message;
    const Nodes meant = Meant(rule.From, what, rule.Line);
    const bool somebodyHasIt =
        std::any_of(meant.begin(), meant.end(),
                    [&rule](const GatewayConfig *other) { return Offered(*other, rule.Message) != nullptr; });
    if (!somebodyHasIt && !meant.empty())
    {
        Fail(rule.Line,
             what + ": " +
                 (IsEverybody(rule.From) ? "nobody publishes it"
                  : meant.size() == 1    ? meant.front()->Node + " does not publish it"
                                         : "none of " + ListedNames(NamesOf(meant)) + " publishes it") +
                 NearestWordHint(rule.Message, MessagesOf(meant)));
        return;
    }
    for (const GatewayConfig *other : meant)
    {
        const PublishRule *published = Offered(*other, rule.Message);
        if (published == nullptr && !IsEverybody(rule.From))
        {
            Fail(rule.Line, what + ": " + other->Node + " does not publish it" +
                                NearestWordHint(rule.Message, MessagesOf({other})));
        }
        else if (published != nullptr && published->Type != rule.Type)
        {
            Fail(rule.Line, what + ": " + other->Node + " publishes it as `" + published->Type +
                                "`, this node wants `" + rule.Type + "`");
        }
        else if (published != nullptr && rule.Qos == QosProfile::State &&
                 published->Qos == QosProfile::Telemetry)
        {
            Fail(rule.Line,
                 what + ": " + other->Node + " publishes it with qos telemetry, this node wants qos state");
        }
    }
}

void WantCheck::CheckAcceptance(const AcceptRule &rule)
{
    if (!IsEverybody(rule.From))
    {
        static_cast<void>(Meant(rule.From, "accept " + rule.Queue, rule.Line, MayBe::Tool));
    }
}

void WantCheck::CheckSending(const SendRule &rule)
{
    const std::string what = "send " + rule.To + "/" + rule.Queue;
    if (rule.To == "*" && rule.Queue == "*")
    {
        return;
    }
    const Nodes meant = Meant({rule.To}, what, rule.Line);
    std::vector<std::string> refusing;
    bool isTaken = false;
    for (const GatewayConfig *other : meant)
    {
        for (const AcceptRule &accepted : other->Accept)
        {
            if (MatchesPattern(rule.Queue, accepted.Queue))
            {
                isTaken = isTaken || MatchesAny(accepted.From, _config.Node);
                refusing.push_back(other->Node);
            }
        }
    }
    if (meant.empty() || isTaken)
    {
        return;
    }
    if (refusing.empty())
    {
        Fail(rule.Line, what + ": " +
                            (rule.To == "*"      ? std::string("nobody accepts")
                             : meant.size() == 1 ? meant.front()->Node + " does not accept"
                                                 : "none of " + ListedNames(NamesOf(meant)) + " accepts") +
                            " such a queue" + NearestWordHint(rule.Queue, QueuesOf(meant)));
        return;
    }
    Fail(rule.Line, what + ": " + ListedNames(refusing) + (refusing.size() == 1 ? " accepts" : " accept") +
                        " it from others only, not from " + _config.Node);
}

}  // namespace Rabit::Tool
