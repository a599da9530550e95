#pragma once

#include <algorithm>

namespace Rabit::Rtps
{

// The accepted value of one thing that an unauthenticated peer claims, and the last other value. Another
// value is accepted when it came OftenEnough in a row, so that an honest peer can change, and one forged or
// damaged datagram changes nothing. Not thread-safe.
template <typename Value>
class Claim
{
public:
    // Number of identical contradicting copies before a changed value is accepted.
    static constexpr int OftenEnough = 3;

    Claim() = default;
    explicit Claim(const Value &accepted) : _accepted(accepted) {}

    const Value &Accepted() const { return _accepted; }
    // True for the accepted value; others are then counted from the beginning again.
    bool IsAccepted(const Value &value)
    {
        _times = value == _accepted ? 0 : _times;
        return value == _accepted;
    }
    // Counts another value. True if it came often enough; it is not accepted thereby.
    bool IsRepeated(const Value &value)
    {
        _times = value == _other ? std::min(_times + 1, OftenEnough) : 1;
        _other = value;
        return _times >= OftenEnough;
    }
    // Both. Accepts a value that came often enough.
    bool Accepts(const Value &value)
    {
        const bool isRepeated = !IsAccepted(value) && IsRepeated(value);
        if (isRepeated)
        {
            *this = Claim(value);
        }
        return isRepeated || value == _accepted;
    }

private:
    Value _accepted{};
    Value _other{};
    int _times = 0;  // that the other one came in a row
};

}  // namespace Rabit::Rtps
