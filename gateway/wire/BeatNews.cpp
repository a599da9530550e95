#include "wire/BeatNews.h"

namespace Rabit
{

const Gateway::BeatNews &NewsOf(const Gateway::Beat &beat)
{
    static const Gateway::BeatNews none;
    return beat.more._d() ? beat.more.news() : none;
}

Gateway::BeatNews &NewsOf(Gateway::Beat &beat)
{
    if (!beat.more._d())
    {
        beat.more.news(Gateway::BeatNews());
    }
    return beat.more.news();
}

void DropEmptyNews(Gateway::Beat &beat)
{
    if (beat.more._d() && beat.more.news() == Gateway::BeatNews())
    {
        beat.more._default();
    }
}

}  // namespace Rabit
