#include "live/LiveSession.h"

#include <algorithm>
#include <utility>

#include "Output.h"
#include "SafeText.h"

namespace Rabit::Tool
{
namespace
{

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

constexpr std::chrono::seconds RequestTime{10};
constexpr std::chrono::seconds TellPeriod{1};
constexpr std::size_t MostSubscriptions = 10'000;

// Sites of viewers.
constexpr std::string_view Viewers[] = {"https://app.foxglove.dev", "https://studio.foxglove.dev",
                                        "https://lichtblick-suite.github.io"};

boost::asio::ip::address AddressOf(const boost::asio::ip::tcp::socket &socket)
{
    beast::error_code ignored;
    return socket.remote_endpoint(ignored).address();
}

}  // namespace

LiveSession::LiveSession(boost::asio::ip::tcp::socket socket, LiveContext &context)
    : _context(context),
      _from(AddressOf(socket)),
      _stream(std::move(socket)),
      _timer(_stream.get_executor()),
      _queue(context.Settings.BytesOfViewer)
{
}

LiveSession::~LiveSession()
{
    _context.Viewers -= _context.Sessions.erase(this);
    _context.Seats -= _hasSeat ? 1 : 0;
}

void LiveSession::Begin()
{
    beast::get_lowest_layer(_stream).expires_after(RequestTime);
    http::async_read(beast::get_lowest_layer(_stream), _buffer, _request,
                     [self = shared_from_this()](const beast::error_code &error, std::size_t)
                     {
                         if (!error)
                         {
                             self->OnHandshake();
                         }
                     });
}

void LiveSession::OnHandshake()
{
    const auto now = std::chrono::steady_clock::now();
    const auto pause = _context.Guard && !ShownToken().empty() ? _context.Guard->PauseFor(_from, now)
                                                               : std::chrono::milliseconds(0);
    _timer.expires_after(pause);
    _timer.async_wait(
        [self = shared_from_this()](const beast::error_code &error)
        {
            if (!error)
            {
                const std::string why = self->WhyNot();
                why.empty() ? self->Accept() : self->Refuse(why);
            }
        });
}

std::string_view LiveSession::ShownToken() const
{
    constexpr std::string_view Before = "/?token=";
    const std::string_view target(_request.target().data(), _request.target().size());
    return target.starts_with(Before) ? target.substr(Before.size()) : std::string_view();
}

bool LiveSession::ShowsToken(Keys::TokenGuard &guard) const
{
    const auto now = std::chrono::steady_clock::now();
    const bool isRight = !ShownToken().empty() && guard.IsRight(_from, ShownToken(), now);
    if (const auto line = guard.Line(now))
    {
        Output::Talk(*line);
    }
    return isRight;
}

std::string LiveSession::WhyNot() const
{
    if (!websocket::is_upgrade(_request))
    {
        return "This is no web page: open it in Foxglove or Lichtblick as a Foxglove WebSocket connection.";
    }
    const auto protocols = _request[http::field::sec_websocket_protocol];
    if (!LiveProtocol::ChosenOf({protocols.data(), protocols.size()}))
    {
        return "Only foxglove.websocket.v1 is spoken here.";
    }
    const auto field = _request[http::field::origin];
    const std::string_view origin(field.data(), field.size());
    const auto &more = _context.Settings.Origins;
    const bool isViewer = origin.empty() ||
                          std::find(std::begin(Viewers), std::end(Viewers), origin) != std::end(Viewers) ||
                          std::any_of(more.begin(), more.end(),
                                      [&](const std::string &one) { return one == "*" || one == origin; });
    if (!isViewer)
    {
        return "Pages of " + SafeText(std::string(origin)) + " may not look (--origin).";
    }
    if (_context.Guard && !ShowsToken(*_context.Guard))
    {
        return "Open the whole address that `rabit foxglove` prints: it ends with a token.";
    }
    return _context.Seats >= _context.Settings.MostViewers ? "There are too many viewers." : "";
}

void LiveSession::Refuse(const std::string &why)
{
    _answer.version(_request.version());
    _answer.result(http::status::forbidden);
    _answer.set(http::field::content_type, "text/plain");
    _answer.keep_alive(false);
    _answer.body() = why + "\n";
    _answer.prepare_payload();
    http::async_write(beast::get_lowest_layer(_stream), _answer,
                      [self = shared_from_this()](const beast::error_code &, std::size_t) {});
}

void LiveSession::Accept()
{
    _hasSeat = true;
    ++_context.Seats;
    beast::get_lowest_layer(_stream).expires_never();  // the WebSocket has its own timeouts
    beast::error_code ignored;
    beast::get_lowest_layer(_stream).socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
    websocket::stream_base::timeout timeout{};
    timeout.handshake_timeout = RequestTime;
    timeout.idle_timeout = _context.Settings.Silence;
    timeout.keep_alive_pings = true;
    _stream.set_option(timeout);
    const auto protocols = _request[http::field::sec_websocket_protocol];
    const std::string chosen(*LiveProtocol::ChosenOf({protocols.data(), protocols.size()}));
    _stream.set_option(
        websocket::stream_base::decorator([chosen](websocket::response_type &response)
                                          { response.set(http::field::sec_websocket_protocol, chosen); }));
    _stream.read_message_max(LiveServer::LargestRequest);
    _stream.async_accept(_request,
                         [self = shared_from_this()](const beast::error_code &error)
                         {
                             if (!error)
                             {
                                 self->Opened();
                             }
                         });
}

void LiveSession::Opened()
{
    _open = true;
    _context.Sessions.insert(this);
    ++_context.Viewers;
    Say(LiveProtocol::ServerInfo(_context.Settings.Name, _context.SessionId));
    std::vector<LiveProtocol::Channel> channels;
    for (const auto &[id, offered] : _context.Channels)
    {
        channels.push_back(offered.Channel);
    }
    if (!channels.empty())
    {
        Say(LiveProtocol::Advertise(channels));
    }
    Tick();
    Read();
}

void LiveSession::Offer(const LiveProtocol::Channel &channel)
{
    Say(LiveProtocol::Advertise({&channel, 1}));
}

void LiveSession::Show(const std::shared_ptr<const LiveValue> &value)
{
    const auto found = _subscribed.find(value->Channel);
    if (found == _subscribed.end())
    {
        return;
    }
    const bool isState = _context.Channels.at(value->Channel).IsState;
    for (const std::uint32_t subscription : found->second)
    {
        isState ? _queue.AddState(subscription, value) : _queue.AddValue(subscription, value);
    }
    WriteNext();
}

void LiveSession::Read()
{
    _buffer.consume(_buffer.size());
    _stream.async_read(_buffer,
                       [self = shared_from_this()](const beast::error_code &error, std::size_t)
                       {
                           if (error || !self->_open)
                           {
                               self->End();
                               return;
                           }
                           // Binary messages carry values of viewers, which are not taken.
                           const std::string text =
                               self->_stream.got_text() ? beast::buffers_to_string(self->_buffer.data()) : "";
                           self->OnRequest(LiveProtocol::ReadRequest(text));
                           self->Read();
                       });
}

void LiveSession::OnRequest(const LiveProtocol::Request &request)
{
    using Kind = LiveProtocol::Request::Kind;
    if (request.What == Kind::Unknown)
    {
        Say(LiveProtocol::Status(LiveProtocol::Level::Warning, SafeText(request.Problem), "request"));
        return;
    }
    for (const std::uint32_t id : request.Ids)
    {
        if (const auto found = _subscriptions.find(id); found != _subscriptions.end())
        {
            std::erase(_subscribed[found->second], id);
            _subscriptions.erase(found);
            _queue.Remove(id);
        }
    }
    for (const auto &[id, channel] : request.Subscriptions)
    {
        const auto offered = _context.Channels.find(channel);
        if (offered == _context.Channels.end() || _subscriptions.size() >= MostSubscriptions ||
            !_subscriptions.emplace(id, channel).second)
        {
            Say(LiveProtocol::Status(LiveProtocol::Level::Warning,
                                     "subscription " + std::to_string(id) + " of channel " +
                                         std::to_string(channel) + " is not possible",
                                     "request"));
            continue;
        }
        _subscribed[channel].push_back(id);
        if (offered->second.Last)
        {
            _queue.AddState(id, offered->second.Last);
        }
    }
    WriteNext();
}

void LiveSession::Say(std::string text)
{
    if (!_queue.AddText(std::move(text)))
    {
        End();  // the viewer asks, and does not read the answers
        return;
    }
    WriteNext();
}

// Begins a write if none is under way.
void LiveSession::WriteNext()
{
    if (!_open || _writing)
    {
        return;
    }
    const auto written = [self = shared_from_this()](const beast::error_code &error, std::size_t)
    {
        self->_writing = false;
        if (error)
        {
            self->End();
            return;
        }
        self->WriteNext();
    };
    if (auto text = _queue.TakeText())
    {
        _writing = true;
        _text = std::move(*text);
        _stream.text(true);
        _stream.async_write(boost::asio::buffer(_text), written);
    }
    else if (const auto value = _queue.TakeValue())
    {
        _writing = true;
        _frame = LiveProtocol::MessageData(value->Subscription, value->What->Time, value->What->Bytes);
        ++_context.Shown;
        _stream.binary(true);
        _stream.async_write(boost::asio::buffer(_frame), written);
    }
}

void LiveSession::Tick()
{
    _timer.expires_after(TellPeriod);
    _timer.async_wait(
        [weak = weak_from_this()](const boost::system::error_code &error)
        {
            const auto self = weak.lock();
            if (self && !error && self->_open)
            {
                self->TellDropped();
                self->Tick();
            }
        });
}

// Sends one text for each topic, which replaces the one before.
void LiveSession::TellDropped()
{
    for (const auto &[channel, count] : _queue.TakeDropped())
    {
        _context.Dropped += count;
        const std::string &topic = _context.Channels.at(channel).Channel.Topic;
        Say(LiveProtocol::Status(LiveProtocol::Level::Warning,
                                 topic + ": " + std::to_string(_dropped[channel] += count) +
                                     " values were not shown, this connection is too slow for them",
                                 "dropped " + topic));
    }
}

// Closes at once: an orderly close would wait for a viewer that may not read.
void LiveSession::End()
{
    _open = false;
    _timer.cancel();
    beast::get_lowest_layer(_stream).close();
}

}  // namespace Rabit::Tool
