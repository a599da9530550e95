#include "TapDevice.h"

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

namespace Rabit::Radio
{
namespace
{

// Number of frames that the kernel holds while the program is not scheduled: a second at 10,000 frames a
// second.
constexpr int FramesInKernel = 10'000;

int Checked(int result, const std::string &what)
{
    if (result < 0)
    {
        throw std::system_error(errno, std::generic_category(), what);
    }
    return result;
}

class Descriptor
{
public:
    Descriptor(int file, const std::string &what) : _file(Checked(file, what)) {}
    ~Descriptor()
    {
        if (_file >= 0)
        {
            close(_file);
        }
    }
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;
    int Get() const { return _file; }
    int Release() { return std::exchange(_file, -1); }

private:
    int _file;
};

ifreq RequestFor(const std::string &device)
{
    if (device.empty() || device.size() >= IFNAMSIZ)
    {
        throw std::invalid_argument("no name of a device: " + device);
    }
    ifreq request{};
    std::copy(device.begin(), device.end(), request.ifr_name);
    return request;
}

int OpenHere(const std::string &device, const MacAddress &address)
{
    Descriptor tap(open("/dev/net/tun", O_RDWR | O_CLOEXEC | O_NONBLOCK), "/dev/net/tun");
    ifreq request = RequestFor(device);
    request.ifr_flags = IFF_TAP | IFF_NO_PI;
    Checked(ioctl(tap.Get(), TUNSETIFF, &request), "a TAP device " + device);

    const Descriptor control(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0), "a socket");
    request = RequestFor(device);
    request.ifr_hwaddr.sa_family = ARPHRD_ETHER;
    std::copy(address.begin(), address.end(), request.ifr_hwaddr.sa_data);
    Checked(ioctl(control.Get(), SIOCSIFHWADDR, &request), "the address of " + device);
    request = RequestFor(device);
    request.ifr_qlen = FramesInKernel;
    // The kernel refuses this in the namespace of a user without root, whose devices have 1000 frames.
    if (ioctl(control.Get(), SIOCSIFTXQLEN, &request) < 0 && errno != EPERM)
    {
        Checked(-1, "the queue of " + device);
    }
    // Without IPv6 in the kernel there is no such file, and nothing to switch off.
    std::ofstream("/proc/sys/net/ipv6/conf/" + device + "/disable_ipv6") << "1\n";
    request = RequestFor(device);
    Checked(ioctl(control.Get(), SIOCGIFFLAGS, &request), "the state of " + device);
    request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP);
    Checked(ioctl(control.Get(), SIOCSIFFLAGS, &request), "switching on " + device);
    return tap.Release();
}

}  // namespace

TapDevice::TapDevice(const std::string &space, const std::string &device, const MacAddress &address)
{
    const std::string path = space.find('/') == std::string::npos ? "/run/netns/" + space : space;
    std::exception_ptr failure;
    // A namespace belongs to a thread. This thread ends when it has opened the device there.
    std::thread inside(
        [&]
        {
            try
            {
                const Descriptor target(open(path.c_str(), O_RDONLY | O_CLOEXEC), path);
                Checked(setns(target.Get(), CLONE_NEWNET), "entering " + path);
                _file = OpenHere(device, address);
            }
            catch (...)
            {
                failure = std::current_exception();
            }
        });
    inside.join();
    if (failure)
    {
        std::rethrow_exception(failure);
    }
}

TapDevice::~TapDevice()
{
    if (_file >= 0)
    {
        close(_file);
    }
}

int TapDevice::Release()
{
    return std::exchange(_file, -1);
}

}  // namespace Rabit::Radio
