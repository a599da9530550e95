// The configuration text that the vendor reads.
#include "DomainConfig.h"

#include <gtest/gtest.h>

#include <locale>
#include <string>

namespace
{

// Writes 1400 as 1,400, as the locales of many languages do.
class GroupedDigits : public std::numpunct<char>
{
protected:
    char do_thousands_sep() const override { return ','; }
    std::string do_grouping() const override { return "\3"; }
};

class GlobalLocale
{
public:
    explicit GlobalLocale(const std::locale &locale) : _before(std::locale::global(locale)) {}
    ~GlobalLocale() { std::locale::global(_before); }
    GlobalLocale(const GlobalLocale &) = delete;
    GlobalLocale &operator=(const GlobalLocale &) = delete;

private:
    const std::locale _before;
};

TEST(DomainConfig, IsTheSameInEachLocale)
{
    Rabit::TransportSettings settings;
    settings.Peers = {"127.0.0.1"};
    const std::string classic = Rabit::Cyclone::MakeDomainConfig(settings, 0);
    ASSERT_NE(classic.find("1400B"), std::string::npos);
    const GlobalLocale grouped(std::locale(std::locale::classic(), new GroupedDigits));
    EXPECT_EQ(Rabit::Cyclone::MakeDomainConfig(settings, 0), classic);
}

// Until the seal is there, the vendor must learn nothing.
TEST(DomainConfig, IsDeafAtFirstWithASealAlone)
{
    const std::string deaf = "<ControlTopic><Deaf>true</Deaf></ControlTopic>";
    const Rabit::TransportSettings settings;
    EXPECT_NE(Rabit::Cyclone::MakeDomainConfig(settings, 87).find(deaf), std::string::npos);
    EXPECT_EQ(Rabit::Cyclone::MakeDomainConfig(settings, 0).find("Deaf"), std::string::npos);
}

}  // namespace
