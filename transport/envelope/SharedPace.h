#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <map>

#include "envelope/Types.h"

namespace Rabit::Envelope
{

// Bounds the bytes of introductions (claims and blobs) that a session sends in a second, so that all nodes in
// reach together keep to AllTogether. Each node takes an equal part of it: it counts the nodes whose
// introductions it has heard lately. So one node that brings a large bulletin to a fleet that is quiet has
// MostOfOne.
//
// Recorded claims of many nodes make a node count too many: it is left LeastOfOne, which brings a part of a blob
// and a claim every two seconds. Nodes are counted by their certificates, which nobody can invent.
//
// A token bucket that may go below zero by one datagram. Time is passed in. Not thread-safe.
class SharedPace
{
public:
    // Of IP and UDP, which are counted with each datagram.
    static constexpr std::size_t IpAndUdp = 28;

    // Bytes a second. AllTogether: a quarter of what a radio of 250 kbit/s carries.
    static constexpr double AllTogether = 8000.0;
    static constexpr double MostOfOne = 6000.0;
    static constexpr double LeastOfOne = 1000.0;
    // Bytes that may be saved up, by all nodes together. A node has as much at the start.
    static constexpr double Burst = 1500.0;
    // A node counts for this time after its last introduction. With LeastOfOne it sends one datagram in it.
    static constexpr std::chrono::seconds Counts{2};
    // Of more nodes each has LeastOfOne.
    static constexpr std::size_t MostOthers = 7;

    // A node with a certificate of that serial sent a claim or a blob, whose signature was verified.
    void Heard(Serial node, TimePoint now)
    {
        Forget(now);
        if (_others.size() < MostOthers || _others.contains(node))
        {
            _others.insert_or_assign(node, now);
        }
    }

    // True if a datagram may go now.
    bool IsFree(TimePoint now)
    {
        if (now > _filledAt)
        {
            _left = std::min(_left + _rate * std::chrono::duration<double>(now - _filledAt).count(), Burst);
            _filledAt = now;
        }
        Forget(now);
        const double nodes = 1.0 + static_cast<double>(_others.size());
        _rate = std::clamp(AllTogether / nodes, LeastOfOne, MostOfOne);
        _left = std::min(_left, Burst / nodes);
        return _left >= 0.0;
    }
    // From when on a datagram may go, if as many nodes are heard as at the last call of IsFree.
    TimePoint Free() const
    {
        using Span = TimePoint::duration;
        return _left >= 0.0
                   ? TimePoint{}
                   : _filledAt + std::chrono::ceil<Span>(std::chrono::duration<double>(-_left / _rate)) +
                         Span(1);
    }
    // A datagram of so many bytes went, headers of IP and UDP not counted.
    void Take(std::size_t bytes) { _left -= static_cast<double>(bytes + IpAndUdp); }

private:
    void Forget(TimePoint now)
    {
        std::erase_if(_others, [now](const auto &each) { return now - each.second > Counts; });
    }

    double _rate = MostOfOne;
    double _left = Burst;
    TimePoint _filledAt{};
    std::map<Serial, TimePoint> _others;  // when each node was heard last
};

}  // namespace Rabit::Envelope
