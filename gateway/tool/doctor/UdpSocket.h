#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <utility>

namespace Rabit::Tool::Doctor
{

// An open descriptor of a socket or event, closed with the object; or none.
class UdpSocket
{
public:
    explicit UdpSocket(int descriptor) : _descriptor(descriptor) {}
    ~UdpSocket()
    {
        if (_descriptor >= 0)
        {
            ::close(_descriptor);
        }
    }
    UdpSocket(UdpSocket &&other) noexcept : _descriptor(std::exchange(other._descriptor, -1)) {}
    UdpSocket &operator=(UdpSocket &&) = delete;

    int Get() const { return _descriptor; }
    bool IsOpen() const { return _descriptor >= 0; }

    template <typename Value>
    bool Set(int level, int option, const Value &value) const
    {
        return ::setsockopt(_descriptor, level, option, &value, sizeof value) == 0;
    }

private:
    int _descriptor;
};

}  // namespace Rabit::Tool::Doctor
