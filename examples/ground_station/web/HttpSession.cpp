#include "HttpSession.h"

#include "PageSession.h"

#include <rabit/RabitLog.h>

#include <boost/beast/core/detect_ssl.hpp>
#include <boost/beast/websocket.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

namespace Ground
{
namespace
{
namespace http = boost::beast::http;

boost::asio::ip::address AddressOf(const boost::asio::ip::tcp::socket &socket)
{
    boost::system::error_code ignored;
    return socket.remote_endpoint(ignored).address();
}
}  // namespace

void SayWrongTokens(ServerContext &context)
{
    if (!context.Secrets)
        return;
    if (const auto line = context.Secrets->Guard.Line(std::chrono::steady_clock::now()))
        Rabit::RabitLog::Write(Rabit::RabitLogLevel::Warning, *line);
}

HttpSession::HttpSession(boost::asio::ip::tcp::socket socket, std::unique_ptr<ConnectionSlot> slot,
                         ServerContext &context)
    : _context(context),
      _id(slot->Id()),
      _from(AddressOf(socket)),
      _slot(std::move(slot)),
      _stream(boost::beast::tcp_stream(std::move(socket))),
      _pause(_stream.get_executor()),
      _buffer(WebServer::MaxHeaderBytes + 1024)
{
    _context.Requests[_id] = this;
}

HttpSession::~HttpSession()
{
    _context.Requests.erase(_id);
}

void HttpSession::Drop()
{
    _pause.cancel();
    Lowest().close();
}

void HttpSession::Begin()
{
    _context.Gate.BecomesIdle(_id);
    if (_context.Secrets && _context.Secrets->Tls)
        TellWhetherTls();
    else
        Read();
}

void HttpSession::TellWhetherTls()
{
    Lowest().expires_after(_context.Settings.RequestTime);
    boost::beast::async_detect_ssl(
        Lowest(), _buffer,
        [self = shared_from_this()](const boost::beast::error_code &error, bool isTls)
        {
            if (error)
                self->Close();
            else if (isTls)
                self->ShakeHands();
            else
                self->Read();  // to answer that the page needs TLS
        });
}

void HttpSession::ShakeHands()
{
    Lowest().expires_after(_context.Settings.RequestTime);
    _stream.UseTls(*_context.Secrets->Tls)
        .async_handshake(boost::asio::ssl::stream_base::server, _buffer.data(),
                         [self = shared_from_this()](const boost::beast::error_code &error, std::size_t used)
                         {
                             self->_buffer.consume(used);
                             if (!error)
                                 self->Read();
                             else
                                 ++self->_context.HandshakesFailed;
                         });
}

void HttpSession::Read()
{
    _context.Gate.BecomesIdle(_id);
    _parser.emplace();
    _parser->header_limit(WebServer::MaxHeaderBytes);
    _parser->body_limit(0);
    Lowest().expires_after(_context.Settings.RequestTime);
    http::async_read(_stream, _buffer, *_parser,
                     [self = shared_from_this()](const boost::beast::error_code &error, std::size_t)
                     { self->OnRead(error); });
}

void HttpSession::OnRead(const boost::beast::error_code &error)
{
    if (error)
    {
        // Bytes that are no HTTP get an answer; a peer that left or was too slow does not.
        if (error.category() == http::make_error_code(http::error::bad_method).category() &&
            error != http::error::end_of_stream && error != http::error::partial_message)
            Write(RefuseHttp(http::status::bad_request, "That is no request that is answered here.", 11,
                             false));
        else
            Close();
        return;
    }
    _request = _parser->release();
    if (!_context.Secrets)
        Answer();
    else if (_context.Secrets->Tls && _stream.GetTls() == nullptr)
        Write(RefuseHttp(http::status::bad_request,
                         "This page is served by TLS alone: its address begins with https://.",
                         _request.version(), false));
    else
        CheckToken();
}

// While it waits the connection is idle, so another one may replace it.
void HttpSession::CheckToken()
{
    const ServerSecrets &secrets = *_context.Secrets;
    const bool isQuick = _knowsToken || TokensOf(_request, secrets.Cookie).empty();
    const auto pause = isQuick ? std::chrono::milliseconds(0)
                               : secrets.Guard.PauseFor(_from, std::chrono::steady_clock::now());
    if (pause.count() == 0)
    {
        Answer();
        return;
    }
    _pause.expires_after(pause);
    _pause.async_wait(
        [self = shared_from_this()](const boost::beast::error_code &error)
        {
            if (error)
                self->Close();
            else
                self->Answer();
        });
}

bool HttpSession::ShowsToken()
{
    ServerSecrets &secrets = *_context.Secrets;
    const auto tokens = TokensOf(_request, secrets.Cookie);
    const auto now = std::chrono::steady_clock::now();
    _knowsToken =
        std::any_of(tokens.begin(), tokens.end(),
                    [&](std::string_view token) { return secrets.Guard.IsRight(_from, token, now); });
    SayWrongTokens(_context);
    return _knowsToken;
}

void HttpSession::Answer()
{
    _context.Gate.BecomesBusy(_id);
    if (_context.Secrets && !ShowsToken())
    {
        Write(AskForToken(_request));
        return;
    }
    if (!boost::beast::websocket::is_upgrade(_request))
    {
        const bool opens =
            _context.Secrets && HasTokenInTarget(_request) && _context.Guard.IsHostAllowed(HostOf(_request));
        Write(opens ? LetIn(_request, _context.Secrets->Cookie, _context.Secrets->Token,
                            _context.Secrets->Tls.has_value())
                    : AnswerHttp(_request, _context.Files, _context.Pictures, _context.Guard));
        return;
    }
    const std::string refusal = RefusalOfUpgrade(_request, _context.Guard);
    if (!refusal.empty())
    {
        Write(RefuseHttp(http::status::forbidden, refusal, _request.version(), false));
        return;
    }
    std::make_shared<PageSession>(std::move(_stream), std::move(_slot), _context)->Accept(_request);
}

void HttpSession::Write(HttpResponse response)
{
    _response = std::move(response);
    Lowest().expires_after(_context.Settings.RequestTime);
    http::async_write(_stream, *_response,
                      [self = shared_from_this()](const boost::beast::error_code &error, std::size_t)
                      {
                          if (error || self->_response->need_eof())
                              self->Close();
                          else
                              self->Read();
                      });
}

void HttpSession::Close()
{
    boost::beast::error_code ignored;
    WebStream::Tls *const tls = _stream.GetTls();
    if (tls == nullptr)
    {
        Lowest().socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
        return;
    }
    // Sends TLS's close_notify, and waits for the peer's, or for a connection that needs the place.
    _context.Gate.BecomesIdle(_id);
    Lowest().expires_after(_context.Settings.RequestTime);
    tls->async_shutdown([self = shared_from_this()](const boost::beast::error_code &) {});
}

}  // namespace Ground
