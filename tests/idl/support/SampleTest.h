// Tests that look at every sample in turn.
#pragma once

#include "Samples.h"

#include <gtest/gtest.h>

// TEST_EACH_SAMPLE(Suite, Name) { ... message ... }: the body runs once for each sample; a failure names it.
#define TEST_EACH_SAMPLE(suite, name)                                   \
    void suite##_##name##_With(const Rabit::RabitMessage &message);     \
    TEST(suite, name)                                                   \
    {                                                                   \
        for (const Sample &sample : AllSamples())                       \
        {                                                               \
            const testing::ScopedTrace trace("sample", 0, sample.Name); \
            suite##_##name##_With(*sample.Message);                     \
        }                                                               \
    }                                                                   \
    void suite##_##name##_With(const Rabit::RabitMessage &message)
