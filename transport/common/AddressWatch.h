// Tells when the IPv4 addresses or the interfaces of this host change.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <thread>

namespace Rabit
{

class AddressWatch
{
public:
    // Calls `look` on a thread of its own: at once, after each burst of changes, and at least twice a second
    // while changes come without a pause. `look` returns the time after which to call it again even without a
    // change; none: call it only after a change. Throws std::system_error if the kernel does not report
    // changes.
    explicit AddressWatch(std::function<std::optional<std::chrono::milliseconds>()> look);
    // Returns when `look` does not run any more.
    ~AddressWatch();
    AddressWatch(const AddressWatch &) = delete;
    AddressWatch &operator=(const AddressWatch &) = delete;

private:
    class Descriptor
    {
    public:
        Descriptor(int value, const char *what);
        ~Descriptor();
        Descriptor(const Descriptor &) = delete;
        Descriptor &operator=(const Descriptor &) = delete;
        int Get() const { return _value; }

    private:
        const int _value;
    };

    enum class Event
    {
        News,
        Silence,  // the wait ended without a change
        Stop
    };

    void Run();
    Event Wait(int milliseconds);

    const std::function<std::optional<std::chrono::milliseconds>()> _look;
    const Descriptor _netlink;
    const Descriptor _stop;
    std::thread _thread;
};

}  // namespace Rabit
