#include "Orders.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <sstream>
#include <stdexcept>

namespace TestNode
{

void Orders::Read()
{
    pollfd input{STDIN_FILENO, POLLIN, 0};
    while (!_ended && poll(&input, 1, 0) > 0)
    {
        std::array<char, 4096> bytes;
        const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
        _ended = count <= 0;
        _rest.append(bytes.data(), _ended ? 0 : static_cast<std::size_t>(count));
    }
    for (std::size_t end = _rest.find('\n'); end != std::string::npos; end = _rest.find('\n'))
    {
        const std::string line = _rest.substr(0, end);
        _rest.erase(0, end + 1);
        Add(line);
    }
}

void Orders::Add(const std::string &line)
{
    if (line == "take")
    {
        _mayTake = true;
        return;
    }
    if (line == "return")
    {
        _mayReturn = true;
        _mayReturn.notify_all();
        return;
    }
    std::istringstream words(line);
    std::string what;
    std::uint64_t count = 0;
    if (!(words >> what >> count) || (what != "notes" && what != "states"))
    {
        throw std::runtime_error("not an order: '" + line +
                                 "'; write 'notes N', 'states N', 'take' or 'return'");
    }
    (what == "notes" ? _notes : _states) += count;
}

}  // namespace TestNode
