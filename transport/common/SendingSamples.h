#pragma once

namespace Rabit
{

// While an object lives, this thread's datagrams count as samples: their encryption hides that.
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
