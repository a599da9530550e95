#include "WebServer.h"

#include "HttpSession.h"
#include "PageSession.h"

#include <boost/asio/post.hpp>

#include <stdexcept>
#include <utility>

namespace Ground
{
namespace
{
// Guards by the allowed host names: those of this machine, and those in its certificate.
RequestGuard GuardOf(const WebServer::Settings &settings)
{
    std::vector<std::string> names = NamesOfThisHost();
    const bool hasTls = settings.Secrets && settings.Secrets->HasTls();
    if (hasTls)
        for (std::string &name : NamesIn(settings.Secrets->Certificate))
            names.push_back(std::move(name));
    return {settings.Endpoint.address().is_loopback(), std::move(names), hasTls};
}

boost::asio::ssl::context TlsOf(const WebSecrets &secrets)
{
    namespace ssl = boost::asio::ssl;
    ssl::context tls(ssl::context::tls_server);
    try
    {
        tls.set_options(ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1 | SSL_OP_NO_RENEGOTIATION);
        SSL_CTX_set_mode(tls.native_handle(), SSL_MODE_RELEASE_BUFFERS);
        SSL_CTX_set_session_cache_mode(tls.native_handle(), SSL_SESS_CACHE_OFF);
        tls.use_certificate_chain(boost::asio::buffer(secrets.Certificate));
        tls.use_private_key(boost::asio::buffer(secrets.Key), ssl::context::pem);
    }
    catch (const boost::system::system_error &error)
    {
        throw WebServerError("The web page cannot be served with that certificate: " +
                             error.code().message());
    }
    return tls;
}

std::unique_ptr<ServerSecrets> SecretsOf(const WebServer::Settings &settings, std::uint16_t port)
{
    if (!settings.Secrets)
        return nullptr;
    const WebSecrets &secrets = *settings.Secrets;
    std::optional<boost::asio::ssl::context> tls;
    if (secrets.HasTls())
        tls = TlsOf(secrets);
    // Cookies belong to a host, for all its ports, so two ground stations on one machine need different
    // names. Because of the prefix the browser accepts the cookie only from this host by TLS.
    const std::string prefix = tls ? "__Host-" : "";
    return std::make_unique<ServerSecrets>(
        ServerSecrets{std::move(tls), Rabit::Keys::TokenGuard(secrets.Token), secrets.Token,
                      prefix + "rabit-" + std::to_string(port)});
}
}  // namespace

WebServer::WebServer(const Settings &settings, std::span<const PageFile> files)
    : _context(new ServerContext{settings,
                                 files,
                                 GuardOf(settings),
                                 nullptr,
                                 {},
                                 {},
                                 ConnectionGate(settings.Connections),
                                 {},
                                 {},
                                 {}}),
      _endpoint(settings.Endpoint)
{
    Listen();
    _context->Secrets = SecretsOf(settings, _endpoint.port());
}

WebServer::~WebServer()
{
    Stop();
}

void WebServer::Start(RequestHandler handler)
{
    if (!_server)
        Listen();
    if (_server->IsStarted())
        throw std::logic_error("WebServer::Start: it is started already");
    _context->Handler = std::move(handler);
    _server->Start("The web server", [this](Rabit::TcpServer::Socket socket) { Take(std::move(socket)); });
}

void WebServer::Stop()
{
    {
        const std::lock_guard lock(_mutex);
        _postable = nullptr;
        _next.reset();
    }
    _server.reset();
    _context->Latest.reset();
}

std::vector<std::string> WebServer::Addresses() const
{
    const auto &secrets = _context->Settings.Secrets;
    std::vector<std::string> lines;
    for (const auto &address : AddressesOf(_endpoint.address()))
        lines.push_back("Web page: " + WebPageUrl({address, _endpoint.port()},
                                                  secrets ? secrets->Token : std::string(),
                                                  secrets && secrets->HasTls()));
    if (secrets && secrets->HasTls())
        lines.push_back("Its certificate, SHA-256: " + FingerprintOf(secrets->Certificate));
    else if (!secrets)
        lines.push_back("Anybody who reaches this port commands the fleet: there is no TLS, and no token.");
    return lines;
}

PictureStore &WebServer::Pictures()
{
    return _context->Pictures;
}

void WebServer::Broadcast(std::shared_ptr<const std::string> snapshot)
{
    const std::lock_guard lock(_mutex);
    if (_postable == nullptr)
        return;
    // At most one call waits, with the latest snapshot, even if the server's thread is slow.
    const bool waiting = _next != nullptr;
    _next = std::move(snapshot);
    if (!waiting)
        boost::asio::post(*_postable, [this] { Distribute(); });
}

WebServer::Counters WebServer::Count() const
{
    return {_context->Connections,      _context->ConnectionsRefused, _context->ConnectionsDropped,
            _context->HandshakesFailed, _context->PagesOpened,        _context->PagesOpen,
            _context->SnapshotsSent,    _context->SnapshotsSkipped};
}

void WebServer::Listen()
{
    try
    {
        _server = std::make_unique<Rabit::TcpServer>(_endpoint);
    }
    catch (const boost::system::system_error &error)
    {
        throw WebServerError("The web page cannot be served at " + WebPageUrl(_endpoint) + ": " +
                             error.code().message());
    }
    _endpoint = _server->Address();
    const std::lock_guard lock(_mutex);
    _postable = &_server->Io();
}

void WebServer::Take(Rabit::TcpServer::Socket socket)
{
    boost::system::error_code ignored;
    const Rabit::TcpServer::Endpoint from =
        socket.remote_endpoint(ignored);  // no address if the peer has left
    const ConnectionGate::Decision decision = _context->Gate.Arrive(from.address());
    if (decision.Dropped)
    {
        ++_context->ConnectionsDropped;
        if (const auto session = _context->Requests.find(*decision.Dropped);
            session != _context->Requests.end())
            session->second->Drop();
    }
    if (!decision.Taken)
    {
        ++_context->ConnectionsRefused;
        socket.close(ignored);
        return;
    }
    ++_context->Connections;
    auto slot = std::make_unique<ConnectionSlot>(*_context, *decision.Taken);
    std::make_shared<HttpSession>(std::move(socket), std::move(slot), *_context)->Begin();
}

void WebServer::Distribute()
{
    {
        const std::lock_guard lock(_mutex);
        _context->Latest = std::exchange(_next, nullptr);
    }
    SayWrongTokens(*_context);
    if (!_context->Latest)
        return;
    for (PageSession *page : _context->Pages)
        page->Offer(_context->Latest);
}

}  // namespace Ground
