#include "ByteChannel.h"

#include "UdpChannel.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/serial_port.hpp>

#include <unistd.h>

#include <charconv>

namespace Swarm
{
namespace
{

namespace asio = boost::asio;

class SerialChannel final : public ByteChannel
{
public:
    SerialChannel(const std::string &device, unsigned baud)
    {
        _port.open(device);
        _port.set_option(asio::serial_port::baud_rate(baud));
        _port.set_option(asio::serial_port::character_size(8));
        _port.set_option(asio::serial_port::parity(asio::serial_port::parity::none));
        _port.set_option(asio::serial_port::stop_bits(asio::serial_port::stop_bits::one));
        _port.set_option(asio::serial_port::flow_control(asio::serial_port::flow_control::none));
    }

    // Asio has no non-blocking calls for serial ports, but opens them such that the system's calls do not
    // block.
    std::size_t Receive(std::span<std::uint8_t> buffer, Time) override
    {
        const ssize_t size = ::read(_port.native_handle(), buffer.data(), buffer.size());
        return size > 0 ? static_cast<std::size_t>(size) : 0;
    }

    // A partly written frame is harmless: its checksum is wrong.
    bool Send(std::span<const std::uint8_t> bytes) override
    {
        return ::write(_port.native_handle(), bytes.data(), bytes.size()) ==
               static_cast<ssize_t>(bytes.size());
    }

private:
    asio::io_context _context;
    asio::serial_port _port{_context};
};

template <typename Number>
Number NumberIn(const std::string &text, Number least, const std::string &description)
{
    Number number = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc() || end != text.data() + text.size() || number < least)
    {
        throw ChannelError(description + ": `" + text + "` is not a number that fits there");
    }
    return number;
}

// Returns the address and port in `PORT`, `ADDRESS:PORT` or `[ADDRESS]:PORT`.
UdpChannel::Endpoint EndpointIn(const std::string &text, const std::string &description)
{
    const std::size_t portAt = text.rfind(':');
    if (portAt == std::string::npos)
    {
        return {asio::ip::address_v4::loopback(), NumberIn<std::uint16_t>(text, 1, description)};
    }
    std::string address = text.substr(0, portAt);
    if (address.starts_with('[') && address.ends_with(']'))
    {
        address = address.substr(1, address.size() - 2);
    }
    boost::system::error_code error;
    const auto parsed = asio::ip::make_address(address, error);
    if (error)
    {
        throw ChannelError(description + ": `" + address + "` is not an IP address of this machine");
    }
    return {parsed, NumberIn<std::uint16_t>(text.substr(portAt + 1), 1, description)};
}

std::unique_ptr<ByteChannel> Open(const std::string &description)
{
    const std::size_t kindEnd = description.find(':');
    const std::string kind = description.substr(0, kindEnd);
    const std::string rest = kindEnd == std::string::npos ? "" : description.substr(kindEnd + 1);
    if (kind == "udp")
    {
        return std::make_unique<UdpChannel>(EndpointIn(rest, description));
    }
    const std::size_t baudAt = rest.rfind(':');
    if (kind == "serial" && baudAt != std::string::npos)
    {
        return std::make_unique<SerialChannel>(rest.substr(0, baudAt),
                                               NumberIn<unsigned>(rest.substr(baudAt + 1), 1, description));
    }
    throw ChannelError("`" + description + "` is neither udp:PORT, udp:ADDRESS:PORT nor serial:DEVICE:BAUD");
}

}  // namespace

std::unique_ptr<ByteChannel> OpenByteChannel(const std::string &description)
{
    try
    {
        return Open(description);
    }
    catch (const boost::system::system_error &error)
    {
        throw ChannelError(description + ": " + error.code().message());
    }
}

}  // namespace Swarm
