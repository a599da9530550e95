#include <gmock/gmock.h>
#include <rabit/transport/TransportFactory.h>

namespace
{

using testing::HasSubstr;

TEST(TransportFactory, MakesEachTransportThatItLists)
{
    ASSERT_FALSE(Rabit::AvailableTransports().empty());
    for (const auto &name : Rabit::AvailableTransports())
    {
        EXPECT_EQ(Rabit::MakeTransport(name)->Name(), name);
    }
}

TEST(TransportFactory, NamesTheTransportsThatExistWhenAskedForAnother)
{
    try
    {
        Rabit::MakeTransport("fastdsd");
        FAIL() << "there is no such transport";
    }
    catch (const Rabit::TransportError &error)
    {
        EXPECT_THAT(error.what(), HasSubstr("fastdsd"));
        for (const auto &name : Rabit::AvailableTransports())
        {
            EXPECT_THAT(error.what(), HasSubstr(name));
        }
    }
}

}  // namespace
