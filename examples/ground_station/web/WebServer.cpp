#include "WebServer.h"

#include "HttpSession.h"
#include "PageSession.h"

#include <rabit/RabitLog.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace Ground
{
namespace
{
using boost::asio::ip::tcp;

std::string HostName()
{
    boost::system::error_code error;
    std::string name = boost::asio::ip::host_name(error);
    return error ? std::string() : name;
}
}  // namespace

// The io_context is made anew for each run: destroying it ends every session.
class WebServer::Core
{
public:
    Core(const Settings &settings, std::span<const PageFile> files)
        : _context{settings, files, RequestGuard(settings.Endpoint.address().is_loopback(), HostName()),
                   {},       {},    ConnectionGate(settings.Connections),
                   {},       {},    {}},
          _endpoint(settings.Endpoint)
    {
        Listen();
    }
    ~Core() { Stop(); }
    Core(const Core &) = delete;
    Core &operator=(const Core &) = delete;

    void Start(RequestHandler handler)
    {
        if (_thread.joinable())
            throw std::logic_error("WebServer::Start: it is started already");
        if (!_io)
            Listen();
        _context.Handler = std::move(handler);
        Accept();
        _thread = std::thread([this] { Serve(); });
    }
    void Stop()
    {
        {
            const std::lock_guard lock(_mutex);
            _postable = nullptr;
            _next.reset();
        }
        if (_thread.joinable())
        {
            _io->stop();
            _thread.join();
        }
        _pause.reset();
        _acceptor.reset();
        _io.reset();
        _context.Latest.reset();
    }
    tcp::endpoint Endpoint() const { return _endpoint; }
    PictureStore &Pictures() { return _context.Pictures; }
    void Broadcast(std::shared_ptr<const std::string> snapshot)
    {
        const std::lock_guard lock(_mutex);
        if (_postable == nullptr)
            return;
        // At most one call waits, with the latest snapshot, however long the server's thread takes.
        const bool waiting = _next != nullptr;
        _next = std::move(snapshot);
        if (!waiting)
            boost::asio::post(*_postable, [this] { Distribute(); });
    }
    Counters Count() const
    {
        Counters counters;
        counters.Connections = _context.Connections;
        counters.ConnectionsRefused = _context.ConnectionsRefused;
        counters.ConnectionsDropped = _context.ConnectionsDropped;
        counters.PagesOpened = _context.PagesOpened;
        counters.PagesOpen = _context.PagesOpen;
        counters.SnapshotsSent = _context.SnapshotsSent;
        counters.SnapshotsSkipped = _context.SnapshotsSkipped;
        return counters;
    }

private:
    static constexpr std::chrono::milliseconds PauseAfterFailure{100};

    void Listen()
    {
        auto io = std::make_unique<boost::asio::io_context>(1);
        auto acceptor = std::make_unique<tcp::acceptor>(*io);
        try
        {
            acceptor->open(_endpoint.protocol());
            acceptor->set_option(tcp::acceptor::reuse_address(true));
            acceptor->bind(_endpoint);
            acceptor->listen();
            _endpoint = acceptor->local_endpoint();
        }
        catch (const boost::system::system_error &error)
        {
            throw WebServerError("The web page cannot be served at " + WebPageUrl(_endpoint) + ": " +
                                 error.code().message());
        }
        _io = std::move(io);
        _acceptor = std::move(acceptor);
        _pause.emplace(*_io);
        const std::lock_guard lock(_mutex);
        _postable = _io.get();
    }
    void Serve()
    {
        while (!_io->stopped())
        {
            try
            {
                _io->run();
            }
            catch (const std::exception &error)
            {
                Rabit::RabitLog::Write(Rabit::RabitLogLevel::Error,
                                       std::string("The web server goes on after: ") + error.what());
            }
        }
    }
    void Accept()
    {
        _acceptor->async_accept([this](const boost::system::error_code &error, tcp::socket socket)
                                { OnAccepted(error, std::move(socket)); });
    }
    void OnAccepted(const boost::system::error_code &error, tcp::socket socket)
    {
        if (error)
        {
            // No file descriptors, for instance. Trying again at once would keep the processor busy.
            _pause->expires_after(PauseAfterFailure);
            _pause->async_wait([this](const boost::system::error_code &) { Accept(); });
            return;
        }
        Take(std::move(socket));
        Accept();
    }
    void Take(tcp::socket socket)
    {
        boost::system::error_code ignored;
        const tcp::endpoint from = socket.remote_endpoint(ignored);  // of one that has left: no address
        const ConnectionGate::Decision decision = _context.Gate.Arrive(from.address());
        if (decision.Dropped)
        {
            ++_context.ConnectionsDropped;
            if (const auto session = _context.Requests.find(*decision.Dropped);
                session != _context.Requests.end())
                session->second->Drop();
        }
        if (!decision.Taken)
        {
            ++_context.ConnectionsRefused;
            socket.close(ignored);
            return;
        }
        ++_context.Connections;
        auto slot = std::make_unique<ConnectionSlot>(_context, *decision.Taken);
        std::make_shared<HttpSession>(std::move(socket), std::move(slot), _context)->Read();
    }
    void Distribute()
    {
        {
            const std::lock_guard lock(_mutex);
            _context.Latest = std::exchange(_next, nullptr);
        }
        if (!_context.Latest)
            return;
        for (PageSession *page : _context.Pages)
            page->Offer(_context.Latest);
    }

    ServerContext _context;
    tcp::endpoint _endpoint;
    std::unique_ptr<boost::asio::io_context> _io;
    std::unique_ptr<tcp::acceptor> _acceptor;
    std::optional<boost::asio::steady_timer> _pause;
    std::thread _thread;
    std::mutex _mutex;
    boost::asio::io_context *_postable = nullptr;  // guarded; null: nobody may post
    std::shared_ptr<const std::string> _next;      // guarded; not null: a call of Distribute waits
};

WebServer::WebServer(const Settings &settings, std::span<const PageFile> files)
    : _core(std::make_unique<Core>(settings, files))
{
}

WebServer::~WebServer() = default;

void WebServer::Start(RequestHandler handler)
{
    _core->Start(std::move(handler));
}

void WebServer::Stop()
{
    _core->Stop();
}

tcp::endpoint WebServer::Endpoint() const
{
    return _core->Endpoint();
}

PictureStore &WebServer::Pictures()
{
    return _core->Pictures();
}

void WebServer::Broadcast(std::shared_ptr<const std::string> snapshot)
{
    _core->Broadcast(std::move(snapshot));
}

WebServer::Counters WebServer::Count() const
{
    return _core->Count();
}

}  // namespace Ground
