#include "Console.h"

#include "Report.h"

#include <nlohmann/json.hpp>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace Rabit::Radio
{
namespace
{

using Words = std::vector<std::string_view>;

// Bounds keep sums of times and sizes far from overflow.
constexpr double MostMilliseconds = 3'600'000;
constexpr double MostBytes = 1e9;

// Tells in words why a command was refused.
class Refused : public std::runtime_error
{
    using std::runtime_error::runtime_error;
};

Words Split(std::string_view line)
{
    Words words;
    while (true)
    {
        const std::size_t begin = line.find_first_not_of(" \t\r\n");
        if (begin == std::string_view::npos)
        {
            return words;
        }
        line.remove_prefix(begin);
        const std::size_t end = std::min(line.find_first_of(" \t\r\n"), line.size());
        words.push_back(line.substr(0, end));
        line.remove_prefix(end);
    }
}

double Number(std::string_view word, double least, double most)
{
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value) || value < least ||
        value > most)
    {
        throw Refused(std::string("not a number in range: ").append(word));
    }
    return value;
}

Time Milliseconds(std::string_view word)
{
    return Time(static_cast<std::int64_t>(std::llround(Number(word, 0, MostMilliseconds) * 1e6)));
}

std::size_t Bytes(std::string_view word)
{
    return static_cast<std::size_t>(Number(word, 0, MostBytes));
}

bool Switch(std::string_view word)
{
    if (word != "on" && word != "off")
    {
        throw Refused(std::string("on or off, not ").append(word));
    }
    return word == "on";
}

// One command while it is carried out.
class Command
{
public:
    Command(Medium &medium, Time now, Words words) : _medium(medium), _now(now), _words(std::move(words)) {}

    void Run()
    {
        const std::string_view what = Next();
        if (what == "rate")
        {
            SetRate();
        }
        else if (what == "queue")
        {
            SetQueue();
        }
        else if (what == "overhead")
        {
            const std::size_t bytes = Bytes(Next());
            End();
            _medium.SetOverhead(bytes);
        }
        else if (what == "delay")
        {
            SetDelay();
        }
        else if (what == "loss")
        {
            SetLoss();
        }
        else if (what == "duplicate")
        {
            const double duplicate = Number(Next(), 0, 100) / 100;
            EachLink([&](LinkSettings &link) { link.Duplicate = duplicate; });
        }
        else if (what == "deaf" || what == "hear")
        {
            SetDeaf(what == "deaf");
        }
        else if (what == "hidden")
        {
            SetHidden();
        }
        else if (what == "reorder" || what == "outage")
        {
            const bool on = Switch(Next());
            End();
            what == "outage" ? _medium.SetOutage(_now, on) : _medium.SetReordering(on);
        }
        else if (what == "reset")
        {
            End();
            _medium.Reset(_now);
        }
        else
        {
            throw Refused(std::string("unknown command: ").append(what));
        }
    }

private:
    std::string_view Next()
    {
        if (_at == _words.size())
        {
            throw Refused("something is missing at the end");
        }
        return _words[_at++];
    }

    void End() const
    {
        if (_at != _words.size())
        {
            throw Refused(std::string("too much: ").append(_words[_at]));
        }
    }

    std::vector<std::size_t> Nodes(std::string_view word) const
    {
        std::vector<std::size_t> nodes;
        for (std::size_t node = 0; node < _medium.Count(); ++node)
        {
            if (word == "*" || word == _medium.NameOf(node))
            {
                nodes.push_back(node);
            }
        }
        if (nodes.empty())
        {
            throw Refused(std::string("no such node: ").append(word));
        }
        return nodes;
    }

    void SetRate()
    {
        const std::string_view word = Next();
        std::optional<std::int64_t> rate;
        if (word != "unlimited")
        {
            rate = static_cast<std::int64_t>(Number(word, 1, static_cast<double>(Medium::MostBitsPerSecond)));
        }
        End();
        _medium.SetRate(_now, rate);
    }

    void SetQueue()
    {
        const std::size_t bytes = Bytes(Next());
        const std::vector<std::size_t> nodes = Nodes(_at == _words.size() ? "*" : Next());
        End();
        for (const std::size_t node : nodes)
        {
            _medium.SetQueue(node, bytes);
        }
    }

    void SetDelay()
    {
        const Time delay = Milliseconds(Next());
        Time jitter{0};
        if (_at < _words.size() && _words[_at] == "jitter")
        {
            ++_at;
            jitter = Milliseconds(Next());
        }
        EachLink(
            [&](LinkSettings &link)
            {
                link.Delay = delay;
                link.Jitter = jitter;
            });
    }

    void SetLoss()
    {
        const double loss = Number(Next(), 0, 100) / 100;
        double burst = 1;
        if (_at < _words.size() && _words[_at] == "burst")
        {
            ++_at;
            burst = Number(Next(), 1, Medium::MostBurst);
        }
        EachLink(
            [&](LinkSettings &link)
            {
                link.Loss = loss;
                link.Burst = burst;
            });
    }

    void SetHidden()
    {
        const std::vector<std::size_t> ones = Nodes(Next());
        const std::vector<std::size_t> others = Nodes(Next());
        const bool hidden = Switch(Next());
        End();
        for (const std::size_t one : ones)
        {
            for (const std::size_t other : others)
            {
                if (one != other)
                {
                    _medium.SetHidden(_now, one, other, hidden);
                }
            }
        }
    }

    void SetDeaf(bool deaf)
    {
        const std::vector<std::size_t> hearers = Nodes(Next());
        const std::vector<std::size_t> senders = Nodes(Next());
        End();
        Change(senders, hearers, [&](LinkSettings &link) { link.Deaf = deaf; });
    }

    // Applies `change` to the links that the rest of the words names: none means all, else FROM TO.
    void EachLink(const std::function<void(LinkSettings &)> &change)
    {
        const bool all = _at == _words.size();
        const std::vector<std::size_t> senders = Nodes(all ? "*" : Next());
        const std::vector<std::size_t> receivers = Nodes(all ? "*" : Next());
        End();
        Change(senders, receivers, change);
    }

    void Change(const std::vector<std::size_t> &senders, const std::vector<std::size_t> &receivers,
                const std::function<void(LinkSettings &)> &change)
    {
        for (const std::size_t from : senders)
        {
            for (const std::size_t to : receivers)
            {
                LinkSettings link = _medium.LinkOf(from, to);
                change(link);
                _medium.SetLink(_now, from, to, link);
            }
        }
    }

    Medium &_medium;
    Time _now;
    Words _words;
    std::size_t _at = 0;
};

}  // namespace

std::string Console::Answer(Time now, std::string_view line)
{
    const Words words = Split(line);
    if (words == Words{"counters"})
    {
        return CountersAsJson(_medium, now);
    }
    if (words == Words{"kinds"})
    {
        return KindsAsJson(_medium);
    }
    try
    {
        Command(_medium, now, words).Run();
        return R"({"ok":true})";
    }
    catch (const Refused &reason)
    {
        using Handler = nlohmann::json::error_handler_t;
        return nlohmann::json{{"error", reason.what()}}.dump(-1, ' ', false, Handler::replace);
    }
}

}  // namespace Rabit::Radio
