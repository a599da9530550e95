#include "wire/BeatNews.h"

namespace Rabit
{

const Gateway::BeatNews &NewsOf(const Gateway::Beat &beat)
{
    static const Gateway::BeatNews none;
    return beat.rest._d() ? beat.rest.news() : none;
}

Gateway::BeatNews &NewsOf(Gateway::Beat &beat)
{
    if (!beat.rest._d())
    {
        beat.rest.news(Gateway::BeatNews());
    }
    return beat.rest.news();
}

void DropEmptyNews(Gateway::Beat &beat)
{
    if (beat.rest._d() && beat.rest.news() == Gateway::BeatNews())
    {
        beat.rest.nothing(0);
    }
}

}  // namespace Rabit
