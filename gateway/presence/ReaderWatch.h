#pragma once

#include <algorithm>
#include <chrono>

namespace Rabit
{

// Detects when the readers of nodes that have appeared are matched. A node is discovered before its reader:
// by a few milliseconds on a wire, by seconds on a thin medium. A beat before that is in vain, and one long
// after it is late. Polled, since no backend reports it.
//
// A pure state machine; `now` never goes back.
class ReaderWatch
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration Period = std::chrono::milliseconds(20);
    // A node whose reader has not come after this time gets the usual beats.
    static constexpr Duration Patience = std::chrono::seconds(10);
    // A reader may have come before the transport reported its node.
    static constexpr Duration Memory = std::chrono::seconds(1);

    // A node has appeared.
    void Expect(Duration now)
    {
        ++_expected;
        _until = now + Patience;
    }

    // `readers` is the number of readers matched now. Returns true if an expected one has come.
    bool Look(int readers, Duration now)
    {
        if (readers > _readers)
        {
            _came = (now - _cameAt <= Memory ? _came : 0) + (readers - _readers);
            _cameAt = now;
        }
        _readers = readers;
        if (now > _until)
        {
            _expected = 0;
        }
        const int found = now - _cameAt <= Memory ? std::min(_expected, _came) : 0;
        _expected -= found;
        _came -= found;
        return found > 0;
    }

    // True if Look is to be called again after Period; otherwise call it now and then, within Memory.
    bool IsExpecting() const { return _expected > 0; }

private:
    int _expected = 0;
    Duration _until{0};
    int _readers = 0;
    int _came = 0;  // readers that came and are not claimed by an expected node yet
    Duration _cameAt{0};
};

}  // namespace Rabit
