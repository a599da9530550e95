#include <rabit/RabitVersion.h>

#include <gtest/gtest.h>

namespace
{

TEST(Version, IsThatOfTheProject)
{
    EXPECT_STREQ(RABIT_VERSION_STRING, RABIT_PROJECT_VERSION);
}

TEST(Version, CanBeComparedByThePreprocessor)
{
#if RABIT_VERSION < RABIT_VERSION_NUMBER(0, 1, 0) || RABIT_VERSION >= RABIT_VERSION_NUMBER(1000, 0, 0)
    FAIL() << RABIT_VERSION;
#endif
    EXPECT_LT(RABIT_VERSION_NUMBER(0, 9, 12), RABIT_VERSION_NUMBER(0, 10, 0));
    EXPECT_LT(RABIT_VERSION_NUMBER(0, 10, 999), RABIT_VERSION_NUMBER(1, 0, 0));
}

}  // namespace
