#include "WebAddress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace
{
using testing::HasSubstr;

std::string RefusalOf(const std::string &text)
{
    try
    {
        Ground::ParseWebAddress(text);
        return "accepted";
    }
    catch (const Ground::WebServerError &error)
    {
        return error.what();
    }
}

TEST(WebAddress, BindsToLoopbackUnlessToldOtherwise)
{
    EXPECT_EQ(Ground::WebPageUrl(Ground::ParseWebAddress("8080")), "http://127.0.0.1:8080/");
}

TEST(WebAddress, TakesAnAddressOfEitherFamily)
{
    EXPECT_EQ(Ground::WebPageUrl(Ground::ParseWebAddress("0.0.0.0:80")), "http://0.0.0.0:80/");
    EXPECT_EQ(Ground::WebPageUrl(Ground::ParseWebAddress("[::1]:8080")), "http://[::1]:8080/");
}

TEST(WebAddress, ShowsTheTokenInTheAddressAndWhetherItIsByTls)
{
    EXPECT_EQ(Ground::WebPageUrl(Ground::ParseWebAddress("8080"), "abc"), "http://127.0.0.1:8080/?token=abc");
    EXPECT_EQ(Ground::WebPageUrl(Ground::ParseWebAddress("[2001:db8::1]:80"), "abc", true),
              "https://[2001:db8::1]:80/?token=abc");
}

TEST(WebAddress, SaysWhereAServerIsReachedThatListensEverywhere)
{
    const auto one = boost::asio::ip::make_address("10.0.0.5");
    EXPECT_THAT(Ground::AddressesOf(one), testing::ElementsAre(one));
    for (const auto &address : Ground::AddressesOf(boost::asio::ip::address_v4::any()))
        EXPECT_TRUE(address.is_v4() && !address.is_loopback()) << address;
}

TEST(WebAddress, RefusesWhatIsNoAddressInOneLine)
{
    for (const char *text : {"", "x", "65536", "-1", "80x", "host:80", "1.2.3:80", "::1:80", "[127.0.0.1]:80",
                             "127.0.0.1:", ":80", "[]:80"})
    {
        EXPECT_THAT(RefusalOf(text), HasSubstr("expected")) << text;
        EXPECT_THAT(RefusalOf(text), testing::Not(HasSubstr("\n"))) << text;
    }
}

}  // namespace
