#include "ByteChannel.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/serial_port.hpp>

#include <unistd.h>

#include <charconv>
#include <optional>

namespace Swarm
{
namespace
{

namespace asio = boost::asio;

class UdpChannel final : public ByteChannel
{
public:
    explicit UdpChannel(std::uint16_t port)
    {
        const asio::ip::udp::endpoint local(asio::ip::udp::v4(), port);
        _socket.open(local.protocol());
        _socket.bind(local);
        _socket.non_blocking(true);
    }

    std::size_t Receive(std::span<std::uint8_t> buffer) override
    {
        boost::system::error_code error;
        asio::ip::udp::endpoint sender;
        const std::size_t size =
            _socket.receive_from(asio::buffer(buffer.data(), buffer.size()), sender, 0, error);
        if (error)
        {
            return 0;
        }
        _peer = sender;
        return size;
    }

    bool Send(std::span<const std::uint8_t> bytes) override
    {
        boost::system::error_code error;
        return _peer &&
               _socket.send_to(asio::buffer(bytes.data(), bytes.size()), *_peer, 0, error) == bytes.size() &&
               !error;
    }

private:
    asio::io_context _context;
    asio::ip::udp::socket _socket{_context};
    std::optional<asio::ip::udp::endpoint> _peer;
};

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
    std::size_t Receive(std::span<std::uint8_t> buffer) override
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

std::unique_ptr<ByteChannel> Open(const std::string &description)
{
    const std::size_t kindEnd = description.find(':');
    const std::string kind = description.substr(0, kindEnd);
    const std::string rest = kindEnd == std::string::npos ? "" : description.substr(kindEnd + 1);
    if (kind == "udp")
    {
        return std::make_unique<UdpChannel>(NumberIn<std::uint16_t>(rest, 1, description));
    }
    const std::size_t baudAt = rest.rfind(':');
    if (kind == "serial" && baudAt != std::string::npos)
    {
        return std::make_unique<SerialChannel>(rest.substr(0, baudAt),
                                               NumberIn<unsigned>(rest.substr(baudAt + 1), 1, description));
    }
    throw ChannelError("`" + description + "` is neither udp:PORT nor serial:DEVICE:BAUD");
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
