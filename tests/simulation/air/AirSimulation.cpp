#include "AirSimulation.h"

#include <algorithm>
#include <deque>
#include <iomanip>
#include <memory>

#include "AirMedium.h"
#include "AirNode.h"

namespace Rabit::Sim
{
namespace
{

using namespace std::chrono_literals;

constexpr Time Propagation = 1ms;

double RateAt(const AirScenario &scenario, Time now)
{
    return now >= scenario.FallsAt && now < scenario.ReturnsAt ? scenario.FallsTo : scenario.BitsPerSecond;
}

// The most bytes of a node within a second.
class MostOfNode
{
public:
    std::uint64_t Add(std::size_t bytes, Time now)
    {
        while (!_last.empty() && _last.front().first + 1s <= now)
        {
            _sum -= _last.front().second;
            _last.pop_front();
        }
        _last.emplace_back(now, bytes);
        return _sum += bytes;
    }

private:
    std::deque<std::pair<Time, std::size_t>> _last;
    std::uint64_t _sum = 0;
};

class Run
{
public:
    Run(const AirScenario &scenario, std::ostream *trace)
        : _scenario(scenario), _trace(trace), _medium(scenario.Nodes, scenario.BitsPerSecond)
    {
        for (std::size_t i = 0; i < scenario.Nodes; ++i)
        {
            _nodes.push_back(std::make_unique<AirNode>(i, scenario));
        }
        _result.BytesOf.resize(scenario.Nodes);
        _most.resize(scenario.Nodes);
    }

    AirResult Go()
    {
        for (Time now{0}; now < _scenario.Ends; now = Next())
        {
            _medium.SetRate(RateAt(_scenario, now));
            Trace(now);
            if (now < _scenario.DeafAt)
            {
                _result.RateWhenDeaf = _nodes[0]->Rate(now);
            }
            _result.RateAtEnd = _nodes[0]->Rate(now);
            while (_medium.NextArrival() && *_medium.NextArrival() <= now)
            {
                Arrived(now);
            }
            for (const auto &node : _nodes)
            {
                if (node->Due() <= now)
                {
                    node->Run(now, _medium);
                }
            }
        }
        const double bits = 8.0 * static_cast<double>(_measured);
        _result.Use = bits / Capacity();
        std::sort(_result.Waits.begin(), _result.Waits.end());
        std::sort(_result.CommandWaits.begin(), _result.CommandWaits.end());
        for (std::size_t i = 0; i < _result.Seconds.size(); ++i)
        {
            AirSecond &second = _result.Seconds[i];
            second.Use = 8.0 * static_cast<double>(second.Bytes) / RateAt(_scenario, Time(i * 1s));
        }
        return std::move(_result);
    }

private:
    Time Next() const
    {
        Time next = _medium.NextArrival().value_or(Time::max());
        for (const auto &node : _nodes)
        {
            next = std::min(next, node->Due());
        }
        return next;
    }

    double Capacity() const
    {
        double bits = 0.0;
        for (Time at = _scenario.Settled; at < _scenario.Ends; at += 100ms)
        {
            bits += RateAt(_scenario, at) * 0.1;
        }
        return bits;
    }

    void Arrived(Time now)
    {
        const Time waited = _medium.Waited();
        const AirPacket packet = _medium.Arrive(now);
        ++_result.Packets;
        const auto number = static_cast<std::size_t>(now / 1s);
        _result.Seconds.resize(std::max(_result.Seconds.size(), number + 1));
        AirSecond &second = _result.Seconds[number];
        second.Bytes += packet.Bytes;
        second.LongestWait = std::max(second.LongestWait, waited);
        ++second.Packets;
        second.Late += waited >= 300ms ? 1 : 0;
        _result.MostInASecond = std::max(_result.MostInASecond, _most[packet.From].Add(packet.Bytes, now));
        if (now >= _scenario.Settled)
        {
            _measured += packet.Bytes;
            _result.BytesOf[packet.From] += packet.Bytes;
            _result.Waits.push_back(waited);
            if (packet.IsCommand)
            {
                _result.CommandWaits.push_back(now - packet.ReadyAt);
            }
        }
        for (std::size_t i = 0; i < _nodes.size(); ++i)
        {
            if (i != packet.From)
            {
                _nodes[i]->Hear(packet, now + Propagation);
            }
        }
    }

    void Trace(Time now)
    {
        if (_trace == nullptr || now < _traced)
        {
            return;
        }
        _traced += 500ms;
        *_trace << std::fixed << std::setprecision(1) << std::chrono::duration<double>(now).count() << " s:";
        for (const auto &node : _nodes)
        {
            const auto rate = node->Rate(now);
            *_trace << ' ' << std::setprecision(0) << rate.value_or(-1.0);
        }
        if (!_result.Seconds.empty())
        {
            *_trace << " wait " << _result.Seconds.back().LongestWait / 1ms << " ms";
        }
        *_trace << '\n';
    }

    const AirScenario _scenario;
    std::ostream *const _trace;
    Time _traced{0};
    AirMedium _medium;
    std::vector<std::unique_ptr<AirNode>> _nodes;
    std::vector<MostOfNode> _most;
    std::uint64_t _measured = 0;
    AirResult _result;
};

}  // namespace

Time AirResult::Quantile(const std::vector<Time> &ascending, double share)
{
    return ascending.empty()
               ? Time(0)
               : ascending[static_cast<std::size_t>(share * static_cast<double>(ascending.size() - 1))];
}

AirResult RunAir(const AirScenario &scenario, std::ostream *trace)
{
    return Run(scenario, trace).Go();
}

}  // namespace Rabit::Sim
