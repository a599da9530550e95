#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/streambuf.hpp>

#include <functional>
#include <memory>
#include <string>

namespace Rabit::Radio
{

// Reads lines, and answers each with a line, one after the other. Lives until its input ends, a line is too
// long or an answer cannot be written.
class ControlSession : public std::enable_shared_from_this<ControlSession>
{
public:
    using Stream = boost::asio::posix::stream_descriptor;
    using Answer = std::function<std::string(const std::string &)>;

    ControlSession(Stream in, Stream out, Answer answer, std::function<void()> ended);
    void Start() { Read(); }

private:
    void Read();
    void Write(const std::string &line);

    static constexpr std::size_t LongestLine = 4096;
    Stream _in;
    Stream _out;
    Answer _answer;
    std::function<void()> _ended;
    boost::asio::streambuf _input{LongestLine};
    std::string _output;
};

}  // namespace Rabit::Radio
