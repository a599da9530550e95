#include "PageSession.h"

#include <rabit/RabitLog.h>

#include <exception>
#include <utility>

namespace Ground
{
namespace websocket = boost::beast::websocket;

PageSession::PageSession(WebStream stream, std::unique_ptr<ConnectionSlot> slot, ServerContext &context)
    : _context(context), _slot(std::move(slot)), _stream(std::move(stream))
{
}

PageSession::~PageSession()
{
    if (_context.Pages.erase(this) > 0)
        --_context.PagesOpen;
}

void PageSession::Accept(const HttpRequest &request)
{
    _context.Gate.OpensPage(_slot->Id());
    boost::beast::get_lowest_layer(_stream).expires_never();  // the WebSocket has its own timeouts
    boost::beast::error_code ignored;
    boost::beast::get_lowest_layer(_stream).socket().set_option(boost::asio::ip::tcp::no_delay(true),
                                                                ignored);
    websocket::stream_base::timeout timeout{};
    timeout.handshake_timeout = _context.Settings.RequestTime;
    timeout.idle_timeout = _context.Settings.Silence;
    timeout.keep_alive_pings = true;
    _stream.set_option(timeout);
    _stream.read_message_max(WebServer::MaxMessageBytes);
    _stream.async_accept(request,
                         [self = shared_from_this()](const boost::beast::error_code &error)
                         {
                             if (error)
                                 return;
                             self->_open = true;
                             self->_context.Pages.insert(self.get());
                             ++self->_context.PagesOpen;
                             ++self->_context.PagesOpened;
                             if (self->_context.Latest)
                                 self->Offer(self->_context.Latest);
                             self->Read();
                         });
}

void PageSession::Offer(const std::shared_ptr<const std::string> &snapshot)
{
    if (_snapshot)
        ++_context.SnapshotsSkipped;
    _snapshot = snapshot;
    WriteNext();
}

void PageSession::Read()
{
    _buffer.consume(_buffer.size());
    _stream.async_read(_buffer,
                       [self = shared_from_this()](const boost::beast::error_code &error, std::size_t)
                       {
                           if (!error)
                               self->OnMessage();
                           else
                               self->_open = false;
                       });
}

void PageSession::OnMessage()
{
    if (!_stream.got_text())
    {
        Close(websocket::close_code::unknown_data);
        return;
    }
    const std::string text = boost::beast::buffers_to_string(_buffer.data());
    if (text == "seen")
    {
        if (_underWay > 0)
            --_underWay;
        WriteNext();
        Read();
        return;
    }
    try
    {
        std::string reply = _context.Handler(text);
        if (!reply.empty())
            Reply(std::move(reply));
    }
    catch (const std::exception &error)
    {
        Rabit::RabitLog::Write(Rabit::RabitLogLevel::Error,
                               std::string("A request of a page could not be handled: ") + error.what());
        Close(websocket::close_code::internal_error);
        return;
    }
    if (_open)
        Read();
}

void PageSession::Reply(std::string text)
{
    if (_replies.size() >= WebServer::MaxRepliesWaiting)
    {
        // The page sends requests but reads no answers. An orderly close would wait behind them.
        _open = false;
        boost::beast::get_lowest_layer(_stream).close();
        return;
    }
    _replies.push_back(std::move(text));
    WriteNext();
}

// One write at a time. Replies go first, as a person waits for them.
void PageSession::WriteNext()
{
    if (!_open || _writing)
        return;
    const std::string *text = nullptr;
    const bool isReply = !_replies.empty();
    if (isReply)
    {
        text = &_replies.front();
    }
    else if (_snapshot && _underWay < WebServer::SnapshotsUnderWay)
    {
        _beingSent = std::exchange(_snapshot, nullptr);
        ++_underWay;
        ++_context.SnapshotsSent;
        text = _beingSent.get();
    }
    if (text == nullptr)
        return;
    _writing = true;
    _stream.text(true);
    _stream.async_write(
        boost::asio::buffer(*text),
        [self = shared_from_this(), isReply](const boost::beast::error_code &error, std::size_t)
        {
            self->_writing = false;
            self->_beingSent.reset();
            if (isReply)
                self->_replies.pop_front();
            if (error)
                self->_open = false;
            else
                self->WriteNext();
        });
}

void PageSession::Close(websocket::close_code code)
{
    _open = false;
    if (_writing)
    {
        // An orderly close would have to wait for a page that may not read.
        boost::beast::get_lowest_layer(_stream).close();
        return;
    }
    _stream.async_close(code, [self = shared_from_this()](const boost::beast::error_code &) {});
}

}  // namespace Ground
