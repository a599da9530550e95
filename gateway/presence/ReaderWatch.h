#pragma once

#include <algorithm>
#include <chrono>

namespace Rabit
{

// Who has appeared can be heard of before it can hear: its reader becomes known some time later, a few
// milliseconds on a wire, seconds on a thin medium. Says when that has come for nodes that are expected, so
// that a beat is not said in vain before, and not late after. Polled, for no backend tells.
//
// A pure state machine; `now` never goes back.
class ReaderWatch
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration Period = std::chrono::milliseconds(20);
    // Whose reader has not come after this time hears the usual beats.
    static constexpr Duration Patience = std::chrono::seconds(10);
    // A reader may have come before the transport said whose it is.
    static constexpr Duration Memory = std::chrono::seconds(1);

    // A node has appeared.
    void Expect(Duration now)
    {
        ++_expected;
        _until = now + Patience;
    }

    // So many readers are matched now. Returns whether one has come that was expected.
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

    // Whether to look again after Period; now and then otherwise, within Memory.
    bool IsExpecting() const { return _expected > 0; }

private:
    int _expected = 0;
    Duration _until{0};
    int _readers = 0;
    int _came = 0;  // and were not claimed yet
    Duration _cameAt{0};
};

}  // namespace Rabit
