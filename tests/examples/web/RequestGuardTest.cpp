#include "RequestGuard.h"

#include <gtest/gtest.h>

namespace
{
using Ground::RequestGuard;

TEST(RequestGuard, KnowsAServerOnLoopbackByLoopbackNamesOnly)
{
    const RequestGuard guard(true, {"field"});
    for (const char *host :
         {"127.0.0.1", "127.0.0.1:8080", "localhost:8080", "LOCALHOST", "[::1]:8080", "127.1.2.3:1"})
        EXPECT_TRUE(guard.IsHostAllowed(host)) << host;
    for (const char *host :
         {"evil.example", "evil.example:8080", "field:8080", "192.168.1.1:8080", "localhost.evil.example",
          "127.0.0.1.evil.example", "", ":80", "[::1", "localhost:80:80", "localhost:x", "localhost:", "[]",
          "[]:80", "[evil]:80", "[::1]x"})
        EXPECT_FALSE(guard.IsHostAllowed(host)) << host;
}

TEST(RequestGuard, KnowsAServerOnANetworkByAddressesAndItsOwnName)
{
    const RequestGuard guard(false, {"field", "field.local"});
    for (const char *host :
         {"192.168.1.1:8080", "[fe80::1]:8080", "localhost:8080", "field:8080", "Field.local"})
        EXPECT_TRUE(guard.IsHostAllowed(host)) << host;
    for (const char *host : {"evil.example", "field.evil.example", "field.local.evil.example", ".local", ""})
        EXPECT_FALSE(guard.IsHostAllowed(host)) << host;
}

TEST(RequestGuard, WithoutAHostNameAllowsNoName)
{
    const RequestGuard guard(false, {});
    EXPECT_FALSE(guard.IsHostAllowed(".local"));
    EXPECT_FALSE(guard.IsHostAllowed(""));
}

TEST(RequestGuard, LetsOnlyItsOwnPageOpenAWebSocket)
{
    const RequestGuard guard(true, {});
    EXPECT_TRUE(guard.IsOriginAllowed("http://127.0.0.1:8080", "127.0.0.1:8080"));
    EXPECT_TRUE(guard.IsOriginAllowed("https://field", "field"));
    for (const char *origin :
         {"", "null", "http://evil.example", "http://127.0.0.1:8081", "http://localhost:8080",
          "127.0.0.1:8080", "http://127.0.0.1:8080.evil.example", "ftp://127.0.0.1:8080"})
        EXPECT_FALSE(guard.IsOriginAllowed(origin, "127.0.0.1:8080")) << origin;
}

TEST(RequestGuard, WithTlsLetsNoPageInThatCameWithoutIt)
{
    const RequestGuard guard(false, {}, true);
    EXPECT_TRUE(guard.IsOriginAllowed("https://10.0.0.5:8080", "10.0.0.5:8080"));
    EXPECT_FALSE(guard.IsOriginAllowed("http://10.0.0.5:8080", "10.0.0.5:8080"));
}

}  // namespace
