#include "ControlSession.h"

#include <boost/asio/error.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>

#include <iostream>
#include <istream>
#include <utility>

namespace Rabit::Radio
{

ControlSession::ControlSession(Stream in, Stream out, Answer answer, std::function<void()> ended)
    : _in(std::move(in)), _out(std::move(out)), _answer(std::move(answer)), _ended(std::move(ended))
{
}

void ControlSession::Read()
{
    boost::asio::async_read_until(
        _in, _input, '\n',
        [self = shared_from_this()](const boost::system::error_code &error, std::size_t)
        {
            std::string line;
            std::istream stream(&self->_input);
            if (error || !std::getline(stream, line))
            {
                self->_ended();
                return;
            }
            self->Write(self->_answer(line));
        });
}

void ControlSession::Write(const std::string &line)
{
    _output = line + '\n';
    boost::asio::async_write(_out, boost::asio::buffer(_output),
                             [self = shared_from_this()](const boost::system::error_code &error, std::size_t)
                             { error ? self->_ended() : self->Read(); });
}

}  // namespace Rabit::Radio
