#include "HttpSession.h"

#include "PageSession.h"

#include <boost/beast/websocket.hpp>

#include <utility>

namespace Ground
{
namespace http = boost::beast::http;

HttpSession::HttpSession(boost::asio::ip::tcp::socket socket, std::unique_ptr<ConnectionSlot> slot,
                         ServerContext &context)
    : _context(context),
      _id(slot->Id()),
      _slot(std::move(slot)),
      _stream(std::move(socket)),
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
    _stream.close();
}

void HttpSession::Read()
{
    _context.Gate.BecomesIdle(_id);
    _parser.emplace();
    _parser->header_limit(WebServer::MaxHeaderBytes);
    _parser->body_limit(0);
    _stream.expires_after(_context.Settings.RequestTime);
    http::async_read(_stream, _buffer, *_parser,
                     [self = shared_from_this()](const boost::beast::error_code &error, std::size_t)
                     { self->OnRead(error); });
}

void HttpSession::OnRead(const boost::beast::error_code &error)
{
    if (error)
    {
        // What is not HTTP gets an answer; whoever left or was too slow does not.
        if (error.category() == http::make_error_code(http::error::bad_method).category() &&
            error != http::error::end_of_stream && error != http::error::partial_message)
            Write(RefuseHttp(http::status::bad_request, "That is no request that is answered here.", 11,
                             false));
        else
            Close();
        return;
    }
    _context.Gate.BecomesBusy(_id);
    const HttpRequest request = _parser->release();
    if (!boost::beast::websocket::is_upgrade(request))
    {
        Write(AnswerHttp(request, _context.Files, _context.Pictures, _context.Guard));
        return;
    }
    const std::string refusal = RefusalOfUpgrade(request, _context.Guard);
    if (!refusal.empty())
    {
        Write(RefuseHttp(http::status::forbidden, refusal, request.version(), false));
        return;
    }
    std::make_shared<PageSession>(std::move(_stream), std::move(_slot), _context)->Accept(request);
}

void HttpSession::Write(HttpResponse response)
{
    _response = std::move(response);
    _stream.expires_after(_context.Settings.RequestTime);
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
    _stream.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
}

}  // namespace Ground
