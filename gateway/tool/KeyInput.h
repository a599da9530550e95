#pragma once

#include <termios.h>

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "StandardInput.h"

namespace Rabit::Tool
{

// The keys of the terminal on standard input, as they are pressed. If standard input is no terminal, or
// another program owns it, no key ever comes.
class KeyInput
{
public:
    // `onKey` is called on a thread of its own when a key has come.
    explicit KeyInput(std::function<void()> onKey);
    // Restores the terminal's settings.
    ~KeyInput();
    KeyInput(const KeyInput &) = delete;
    KeyInput &operator=(const KeyInput &) = delete;

    bool IsThere() const { return _reader.joinable(); }
    std::optional<char> Take();

private:
    void Read();

    const std::function<void()> _onKey;
    termios _before{};
    StandardInput _input;
    std::mutex _mutex;
    std::deque<char> _keys;
    std::thread _reader;
};

}  // namespace Rabit::Tool
