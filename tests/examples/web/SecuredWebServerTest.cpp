// The web server with TLS and a token, as it listens beyond this machine.
#include "WebServer.h"

#include "../../Eventually.h"
#include "../../core/CapturedLog.h"
#include "PageClient.h"
#include "RawClient.h"

#include <boost/asio/read.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/write.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace
{
using namespace std::chrono_literals;
using boost::asio::ip::tcp;
using Ground::WebServer;
using GroundTest::PageClient;
using GroundTest::RawClient;
using RabitTest::Eventually;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::Optional;
using testing::StartsWith;

const Ground::PageFile SecuredFiles[] = {{"/", "text/html; charset=utf-8", "<p>page</p>"},
                                         {"/a.js", "text/javascript; charset=utf-8", "let a;"}};

// A client that speaks TLS, and accepts every certificate.
class TlsClient
{
public:
    explicit TlsClient(const tcp::endpoint &server, const char *from = "127.0.0.1") : _raw(server, from) {}
    // Returns all that comes until the server closes; nothing if the server does not speak TLS. WasWhole
    // then tells whether the server ended the TLS session in order.
    std::string Ask(const std::string &request)
    {
        std::string text;
        boost::system::error_code error;
        _stream.handshake(boost::asio::ssl::stream_base::client, error);
        if (!error)
            boost::asio::write(_stream, boost::asio::buffer(request), error);
        if (!error)
            boost::asio::read(_stream, boost::asio::dynamic_buffer(text), error);
        _wasWhole = error == boost::asio::error::eof;
        return text;
    }
    bool WasWhole() const { return _wasWhole; }

private:
    RawClient _raw;
    boost::asio::ssl::context _context{boost::asio::ssl::context::tls_client};
    boost::asio::ssl::stream<tcp::socket &> _stream{_raw.Socket(), _context};
    bool _wasWhole = false;
};

// Returns the first TLS message of a client.
std::string ClientHello()
{
    using ContextPtr = std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)>;
    using SslPtr = std::unique_ptr<SSL, decltype(&SSL_free)>;
    const ContextPtr context(SSL_CTX_new(TLS_client_method()), &SSL_CTX_free);
    const SslPtr ssl(SSL_new(context.get()), &SSL_free);
    SSL_set_bio(ssl.get(), BIO_new(BIO_s_mem()), BIO_new(BIO_s_mem()));
    SSL_connect(ssl.get());
    const char *bytes = nullptr;
    const long size = BIO_get_mem_data(SSL_get_wbio(ssl.get()), &bytes);
    return {bytes, static_cast<std::size_t>(size)};
}

class SecuredWebServerTest : public testing::Test
{
protected:
    const RabitTest::CapturedLog _log;
    WebServer::Settings _settings;
    std::unique_ptr<WebServer> _server;

    void SetUp() override { _settings.Secrets = Ground::MakeWebSecrets({{"field"}, {}}, std::time(nullptr)); }
    void Start()
    {
        _server = std::make_unique<WebServer>(_settings, SecuredFiles);
        _server->Start([](const std::string &text) { return "reply to " + text; });
    }
    tcp::endpoint Endpoint() const { return _server->Endpoint(); }
    const std::string &Token() const { return _settings.Secrets->Token; }
    std::string Cookie(const std::string &token) const
    {
        return "__Host-rabit-" + std::to_string(Endpoint().port()) + "=" + token;
    }
    std::string Cookie() const { return Cookie(Token()); }
    std::string Get(const std::string &target, const std::string &header = {},
                    const char *from = "127.0.0.1") const
    {
        TlsClient client(Endpoint(), from);
        return client.Ask("GET " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" +
                          (header.empty() ? "" : header + "\r\n") + "\r\n");
    }
    bool ServesThePage() const
    {
        return Get("/", "Cookie: " + Cookie()).find("<p>page</p>") != std::string::npos;
    }
};

TEST_F(SecuredWebServerTest, GivesNothingToWhoShowsNoToken)
{
    Start();
    for (const char *target : {"/", "/a.js", "/nothing", "/pictures/uav1", "/live"})
        EXPECT_THAT(Get(target), AllOf(StartsWith("HTTP/1.1 401 "), HasSubstr("open the address"),
                                       Not(HasSubstr("let a")), Not(HasSubstr("Set-Cookie"))))
            << target;
    EXPECT_EQ(PageClient(Endpoint(), "").Open(), 401u);
    EXPECT_THAT(_log.Lines(), testing::IsEmpty()) << "none is no wrong one";
}

TEST_F(SecuredWebServerTest, OpensByTheAddressThatItSaysAndThenByTheCookie)
{
    Start();
    EXPECT_THAT(_server->Addresses(),
                testing::ElementsAre(
                    "Web page: https://127.0.0.1:" + std::to_string(Endpoint().port()) + "/?token=" + Token(),
                    StartsWith("Its certificate, SHA-256: ")));
    EXPECT_THAT(Get("/?token=" + Token()),
                AllOf(StartsWith("HTTP/1.1 200 "), HasSubstr("Set-Cookie: " + Cookie() + ";")));
    EXPECT_TRUE(ServesThePage());
    EXPECT_THAT(Get("/a.js", "Authorization: Bearer " + Token()), StartsWith("HTTP/1.1 200 "));
    PageClient page(Endpoint(), "other=1; " + Cookie());
    ASSERT_EQ(page.Open(), 101u);
    ASSERT_TRUE(page.Send("x"));
    EXPECT_THAT(page.Next(), Optional(std::string("reply to x")));
}

// As it listens on loopback, where other users of the machine reach it.
TEST_F(SecuredWebServerTest, AsksForTheTokenWithoutTls)
{
    _settings.Secrets = Ground::MakeWebToken();
    Start();
    const std::string port = std::to_string(Endpoint().port());
    EXPECT_THAT(_server->Addresses(),
                testing::ElementsAre("Web page: http://127.0.0.1:" + port + "/?token=" + Token()));
    const auto ask = [this](const std::string &target, const std::string &headers)
    {
        RawClient client(Endpoint());
        client.Send("GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(Endpoint().port()) +
                    "\r\n" + headers + "\r\n");
        return client.Rest();
    };
    const std::string close = "Connection: close\r\n";
    const std::string live =
        "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nOrigin: http://127.0.0.1:" +
        port + "\r\n";
    for (const std::string &headers : {close, live, close + "Cookie: rabit-" + port + "=wrong\r\n"})
        EXPECT_THAT(ask(headers == live ? "/live" : "/", headers), StartsWith("HTTP/1.1 401 "));
    EXPECT_EQ(_server->Count().PagesOpened, 0u);
    const std::string cookie = "rabit-" + port + "=" + Token();
    EXPECT_THAT(
        ask("/?token=" + Token(), close),
        AllOf(StartsWith("HTTP/1.1 200 "), HasSubstr("Set-Cookie: " + cookie + "; Path=/; HttpOnly")));
    EXPECT_THAT(ask("/", close + "Cookie: " + cookie + "\r\n"), HasSubstr("<p>page</p>"));
    // A page of another site has the browser send the cookie, but not its own origin.
    const std::string other = live.substr(0, live.find("Origin: ")) + "Origin: null\r\nCookie: " + cookie;
    EXPECT_THAT(ask("/live", other + "\r\n"), StartsWith("HTTP/1.1 403 "));
    RawClient page(Endpoint());
    page.Send("GET /live HTTP/1.1\r\nHost: 127.0.0.1:" + port + "\r\n" + live + "Cookie: " + cookie +
              "\r\n\r\n");
    EXPECT_TRUE(Eventually([this] { return _server->Count().PagesOpened == 1; }));
}

TEST_F(SecuredWebServerTest, TakesNoOrderWithoutTheToken)
{
    Start();
    EXPECT_EQ(PageClient(Endpoint(), "").Open(), 401u);
    EXPECT_EQ(PageClient(Endpoint(), Cookie(std::string(32, '0'))).Open(), 401u);
    EXPECT_EQ(PageClient(Endpoint(), Cookie(Token().substr(1))).Open(), 401u);
    EXPECT_EQ(PageClient(Endpoint(), "__Host-rabit-1=" + Token()).Open(), 401u);
    EXPECT_EQ(_server->Count().PagesOpened, 0u);
}

TEST_F(SecuredWebServerTest, TakesNoOrderOfAnotherSiteThatHasTheCookieSent)
{
    Start();
    const std::string port = std::to_string(Endpoint().port());
    for (const std::string &origin :
         {std::string("https://evil.example"), std::string("none"), "http://127.0.0.1:" + port,
          std::string("https://127.0.0.1:1"), std::string("null")})
        EXPECT_EQ(PageClient(Endpoint(), Cookie()).Open(origin), 403u) << origin;
    EXPECT_EQ(PageClient(Endpoint(), Cookie()).Open("https://evil.example", "evil.example"), 403u);
    EXPECT_EQ(_server->Count().PagesOpened, 0u);
}

TEST_F(SecuredWebServerTest, GivesTheTokenToNoSiteThatHasANameOfItsOwnPointHere)
{
    Start();
    TlsClient client(Endpoint());
    EXPECT_THAT(
        client.Ask("GET /?token=" + Token() + " HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n"),
        AllOf(StartsWith("HTTP/1.1 403 "), Not(HasSubstr("Set-Cookie"))));
}

TEST_F(SecuredWebServerTest, LogsWrongTokensWithTheirAddressInFewLines)
{
    Start();
    for (int i = 0; i < 5; ++i)
        EXPECT_THAT(Get("/?token=guess" + std::to_string(i), {}, "127.0.0.2"), StartsWith("HTTP/1.1 401 "));
    EXPECT_THAT(_log.Lines(),
                testing::ElementsAre("The web page was shown a wrong token: from 127.0.0.2 once"));
}

TEST_F(SecuredWebServerTest, ServesWhoHasTheTokenWhileAnotherAddressGuesses)
{
    Start();
    const std::string guess = "GET /?token=guess HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    std::vector<std::thread> guessers;
    for (int i = 0; i < 20; ++i)
        guessers.emplace_back([&] { TlsClient(Endpoint(), "127.0.0.2").Ask(guess); });
    EXPECT_TRUE(ServesThePage());
    EXPECT_EQ(PageClient(Endpoint(), Cookie()).Open(), 101u);
    EXPECT_THAT(Get("/", "Cookie: " + Cookie(), "127.0.0.2"), StartsWith("HTTP/1.1 200 "))
        << "slowly, but not locked out";
    for (std::thread &guesser : guessers)
        guesser.join();
}

TEST_F(SecuredWebServerTest, StopsAtOnceWhileGuessersWait)
{
    Start();
    const std::string guess = "GET /?token=guess HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    for (int i = 0; i < 6; ++i)
        TlsClient(Endpoint(), "127.0.0.2").Ask(guess);
    std::vector<std::thread> guessers;
    std::atomic<int> refused{0};
    for (int i = 0; i < 8; ++i)
        guessers.emplace_back(
            [&]
            {
                if (TlsClient(Endpoint(), "127.0.0.2").Ask(guess).empty())
                    ++refused;
            });
    ASSERT_TRUE(Eventually([this] { return _server->Count().Connections == 14; }));
    _server->Stop();
    for (std::thread &guesser : guessers)
        guesser.join();
    EXPECT_GT(refused, 0) << "those that waited were not answered any more";
}

TEST_F(SecuredWebServerTest, TellsWhoSpeaksNoTlsThatItShould)
{
    Start();
    RawClient client(Endpoint());
    client.Send("GET /?token=" + Token() + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_THAT(client.Rest(),
                AllOf(StartsWith("HTTP/1.1 400 "), HasSubstr("its address begins with https://"),
                      Not(HasSubstr("page</p>")), Not(HasSubstr("Set-Cookie"))));
    EXPECT_EQ(PageClient(Endpoint()).Open(), 400u);
    RawClient nonsense(Endpoint());
    nonsense.Send("\r\nhello\r\n\r\n");
    EXPECT_THAT(nonsense.Rest(), StartsWith("HTTP/1.1 400 "));
}

TEST_F(SecuredWebServerTest, EndsAHandshakeThatStalls)
{
    _settings.RequestTime = 50ms;
    Start();
    const std::string hello = ClientHello();
    for (const std::string &begin : {std::string(), hello.substr(0, 3), hello.substr(0, 100), hello})
    {
        RawClient client(Endpoint());
        client.Send(begin);
        client.Rest();  // returns when the server has closed
    }
    EXPECT_TRUE(Eventually([this] { return _server->Count().HandshakesFailed == 2; }));
}

TEST_F(SecuredWebServerTest, OpensThePageWhileHundredsOfHandshakesStall)
{
    _settings.RequestTime = std::chrono::minutes(10);  // waiting for them to end would take too long
    Start();
    PageClient before(Endpoint(), Cookie());
    ASSERT_EQ(before.Open(), 101u);
    const std::string hello = ClientHello();
    std::vector<std::unique_ptr<RawClient>> stalled;
    for (std::size_t i = 0; i < 300; ++i)
    {
        stalled.push_back(std::make_unique<RawClient>(Endpoint(), "127.0.0.2"));
        stalled.back()->Send(hello.substr(0, i % 3 == 0 ? 0 : i % 3 == 1 ? 50 : hello.size()));
    }
    EXPECT_TRUE(ServesThePage());
    PageClient page(Endpoint(), Cookie());
    EXPECT_EQ(page.Open(), 101u);
    const auto counters = _server->Count();
    EXPECT_GE(counters.ConnectionsDropped, 270u) << "what is held for those that stall is bounded";
    _server->Broadcast(std::make_shared<const std::string>("still here"));
    EXPECT_THAT(before.Next(), Optional(std::string("still here")));
}

TEST_F(SecuredWebServerTest, GoesOnAfterHostileBytes)
{
    Start();
    std::mt19937 random(20);
    const auto below = [&random](std::size_t end)
    { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random); };
    const std::string hello = ClientHello();
    for (int round = 0; round < 500; ++round)
    {
        std::string bytes = round % 2 == 0 ? hello : std::string("\x16\x03\x01", 3);
        if (round % 2 == 1)
            for (std::size_t left = below(2000); left > 0; --left)
                bytes += static_cast<char>(below(256));
        for (std::size_t left = 1 + below(8); left > 0 && round % 2 == 0; --left)
            bytes[below(bytes.size())] = static_cast<char>(below(256));
        if (round % 5 == 0)
            bytes.resize(below(bytes.size()));
        RawClient client(Endpoint(), "127.0.0.2");
        client.Send(bytes);
        boost::system::error_code ignored;
        client.Socket().shutdown(tcp::socket::shutdown_send, ignored);
        client.Rest();
    }
    EXPECT_TRUE(ServesThePage());
    EXPECT_TRUE(Eventually([this] { return PageClient(Endpoint(), Cookie()).Open() == 101u; }));
}

TEST_F(SecuredWebServerTest, SaysThatAnAnswerIsWhole)
{
    Start();
    TlsClient client(Endpoint());
    client.Ask("GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nCookie: " + Cookie() + "\r\n\r\n");
    EXPECT_TRUE(client.WasWhole()) << "a connection that is cut off could not be told from its end";
}

TEST_F(SecuredWebServerTest, ServesSeveralRequestsOnOneConnection)
{
    Start();
    TlsClient client(Endpoint());
    const std::string cookie = "Host: localhost\r\nCookie: " + Cookie() + "\r\n";
    const std::string answer = client.Ask("GET /a.js HTTP/1.1\r\n" + cookie + "\r\nGET / HTTP/1.1\r\n" +
                                          cookie + "Connection: close\r\n\r\n");
    EXPECT_THAT(answer, AllOf(HasSubstr("let a;"), HasSubstr("<p>page</p>")));
}

TEST_F(SecuredWebServerTest, AsksForTheTokenOnEachRequestOfAConnection)
{
    Start();
    TlsClient client(Endpoint());
    const std::string answer =
        client.Ask("GET /a.js HTTP/1.1\r\nHost: localhost\r\nCookie: " + Cookie() +
                   "\r\n\r\nGET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    EXPECT_THAT(answer,
                AllOf(HasSubstr("let a;"), HasSubstr("HTTP/1.1 401 "), Not(HasSubstr("<p>page</p>"))));
}

TEST_F(SecuredWebServerTest, StartsAgainWithTheSameToken)
{
    Start();
    PageClient page(Endpoint(), Cookie());
    ASSERT_EQ(page.Open(), 101u);
    _server->Stop();
    EXPECT_EQ(page.Next(), std::nullopt);
    _server->Start([](const std::string &) { return "second life"; });
    PageClient again(Endpoint(), Cookie());
    ASSERT_EQ(again.Open(), 101u);
    ASSERT_TRUE(again.Send("x"));
    EXPECT_THAT(again.Next(), Optional(std::string("second life")));
}

TEST_F(SecuredWebServerTest, SaysInOneLineThatItCannotServeWithACertificate)
{
    _settings.Secrets->Certificate = "nonsense";
    try
    {
        const WebServer server(_settings, SecuredFiles);
        FAIL() << "it serves with nonsense";
    }
    catch (const Ground::WebServerError &error)
    {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("certificate"), Not(HasSubstr("\n"))));
    }
}

}  // namespace
