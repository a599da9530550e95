#include "TestMessages.h"

#include <rabit/GlobalPublishSubscribeException.h>
#include <rabit/MessageNotRegisteredException.h>
#include <rabit/RabitStopWatch.h>
#include <rabit/message_pool.h>

#include <gtest/gtest.h>

#include <chrono>
#include <exception>
#include <stdexcept>
#include <string>

namespace
{

using namespace Rabit;
using namespace RabitTest;

using Moment = std::chrono::steady_clock::time_point;

// Returns the time once it is later than that of the last reading.
Moment Later()
{
    const Moment begin = std::chrono::steady_clock::now();
    Moment now = begin;
    while (now == begin)
    {
        now = std::chrono::steady_clock::now();
    }
    return now;
}

void ExpectWithin(double seconds, std::chrono::duration<double> least, std::chrono::duration<double> most)
{
    constexpr double Rounded = 1e-6;  // of a float
    EXPECT_GE(seconds, least.count() * (1.0 - Rounded));
    EXPECT_LE(seconds, most.count() * (1.0 + Rounded));
}

TEST(RabitStopWatch, TickMeasuresFromTheLastTick)
{
    const Moment begin = Later();
    RabitStopWatch watch;
    EXPECT_EQ(watch.getTimeElapsed(), 0.0);
    const Moment first = Later();
    const Moment second = Later();
    watch.tick();
    ExpectWithin(watch.getTimeElapsed(), second - first, Later() - begin);
    const double ticked = watch.getTimeElapsed();
    EXPECT_EQ(watch.getTimeElapsed(), ticked);  // no capture, no change
}

TEST(RabitStopWatch, StopMeasuresFromStart)
{
    RabitStopWatch watch;
    watch.tick();
    const Moment begin = Later();
    watch.start();
    EXPECT_EQ(watch.getTimeElapsed(), 0.0);
    const Moment first = Later();
    const Moment second = Later();
    watch.stop();
    const double once = watch.getTimeElapsed();
    ExpectWithin(once, second - first, Later() - begin);
    Later();
    watch.captureTime();
    EXPECT_GT(watch.getTimeElapsed(), once);
    watch.reset();
    EXPECT_EQ(watch.getTimeElapsed(), 0.0);
}

TEST(Exceptions, SayWhatIsWrong)
{
    EXPECT_NE(std::string(GlobalPublishSubscribeException().what()), "");
    EXPECT_NE(std::string(MessageNotRegisteredException().what()), "");
    EXPECT_STREQ(GlobalPublishSubscribeException("why").what(), "why");
    EXPECT_STREQ(MessageNotRegisteredException("why").what(), "why");
    EXPECT_THROW(throw GlobalPublishSubscribeException(), std::exception);
    EXPECT_THROW(throw MessageNotRegisteredException(), std::exception);
}

TEST(MessagePool, LendsOutWhatItHasAndNoMore)
{
    NumberMessage prototype;
    prototype.Number = 5;
    MessagePool pool(&prototype, 2);
    EXPECT_EQ(pool.GetPoolSize(), 2);
    RabitMessage *first = pool.CheckOutMessage();
    RabitMessage *second = pool.CheckOutMessage();
    ASSERT_NE(first, nullptr);
    ASSERT_NE(second, nullptr);
    EXPECT_NE(first, second);
    EXPECT_EQ(dynamic_cast<NumberMessage &>(*first).Number, 5);
    EXPECT_EQ(pool.CheckOutMessage(), nullptr);
    EXPECT_EQ(pool.GetNumberOfFreeMessages(), 0);
    EXPECT_EQ(pool.GetNumberOfCheckedOutMessages(), 2);
    EXPECT_EQ(pool.CheckInMessage(first), 0);
    EXPECT_EQ(pool.GetNumberOfFreeMessages(), 1);
    EXPECT_EQ(pool.findNumberOfFreeMessages(), 1);
    EXPECT_EQ(pool.CheckOutMessage(), first);
}

TEST(MessagePool, ClearsWhatItTakesBack)
{
    NumberMessage prototype;
    MessagePool pool(&prototype, 1);
    RabitMessage *message = pool.CheckOutMessage();
    message->MessageType = 3;
    pool.CheckInMessage(message);
    EXPECT_EQ(pool.CheckOutMessage()->MessageType, 0);
}

TEST(MessagePool, TellsWhatItCannotTakeBack)
{
    NumberMessage prototype;
    MessagePool pool(&prototype, 0);
    EXPECT_EQ(pool.GetPoolSize(), 1);
    RabitMessage *message = pool.CheckOutMessage();
    EXPECT_EQ(pool.CheckInMessage(nullptr), 0);
    EXPECT_EQ(pool.CheckInMessage(message), 0);
    EXPECT_EQ(pool.CheckInMessage(message), 1);
    NumberMessage foreign;
    foreign.MessageType = 4;
    EXPECT_EQ(pool.CheckInMessage(&foreign), 2);
    EXPECT_EQ(foreign.MessageType, 0);
    EXPECT_EQ(pool.GetNumberOfFreeMessages(), 1);
    EXPECT_THROW(MessagePool(nullptr, 1), std::invalid_argument);
}

}  // namespace
