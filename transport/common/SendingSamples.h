#pragma once

namespace Rabit
{

// While one lives, what this thread sends is of samples, though nobody can see it: it is encrypted.
class SendingSamples
{
public:
    SendingSamples() { ++_depth; }
    ~SendingSamples() { --_depth; }
    SendingSamples(const SendingSamples &) = delete;
    SendingSamples &operator=(const SendingSamples &) = delete;
    static bool Now() { return _depth > 0; }

private:
    static inline thread_local int _depth = 0;
};

}  // namespace Rabit
