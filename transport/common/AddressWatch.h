// Tells when the IPv4 addresses of this host change.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace Rabit
{

class AddressWatch
{
public:
    // Calls `changed` on a thread of its own, once after each burst of changes to interfaces and addresses.
    // What it returns is the time after which to call it again even without a change; none if that is zero.
    // Throws std::system_error if the kernel does not tell of changes.
    explicit AddressWatch(std::function<std::chrono::milliseconds()> changed);
    // Returns when `changed` does not run any more.
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

    void Run();
    // False: it is to stop.
    bool Wait(int milliseconds, bool &news);

    const std::function<std::chrono::milliseconds()> _changed;
    const Descriptor _netlink;
    const Descriptor _stop;
    std::thread _thread;
};

}  // namespace Rabit
