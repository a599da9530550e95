#include "agreement/ClaimBallots.h"

#include <algorithm>
#include <tuple>

namespace Rabit
{

ClaimBallots::ClaimBallots(const AgreementSettings &settings, std::uint64_t fences, Duration now)
    : _settings(settings),
      _group(settings.Group()),
      _fences(fences),
      _stored(fences),
      _votesFrom(now + settings.VotersLease())
{
}

std::optional<ClaimReply> ClaimBallots::OnRequest(std::string_view from, const ClaimRequest &request,
                                                  Duration now, bool *waits)
{
    EndBooks(now);
    if (!_settings.IsMember(from) || request.Group != _group || now < _votesFrom)
    {
        return std::nullopt;
    }
    const auto found = BookOf(from, request, now);
    if (found == _books.end())
    {
        return std::nullopt;
    }
    auto &[number, book] = *found;
    if (request.Renewal > book.Renewal)
    {
        book.Renewal = request.Renewal;
        book.Until = now + _settings.VotersLease();
    }
    ClaimReply reply{.Group = _group,
                     .Incarnation = _settings.Incarnation,
                     .Claimant = request.Incarnation,
                     .Session = request.Session,
                     .Book = number,
                     .Renewal = book.Renewal};
    // A late copy of an order must not do what a later one has undone.
    if (request.Book == number && request.Number > book.Number)
    {
        if (MustStore(request))
        {
            if (waits != nullptr)
            {
                *waits = true;
            }
            return std::nullopt;
        }
        book.Number = request.Number;
        reply.Number = request.Number;
        for (const ClaimOrder &order : request.Orders)
        {
            reply.Results.push_back(Obey(order, *found, now));
        }
    }
    reply.Fences = _fences;
    return reply;
}

void ClaimBallots::EndBooks(Duration now)
{
    // Renewals only make a book longer.
    if (now < _firstEnd)
    {
        return;
    }
    std::erase_if(_grants, [&](const auto &grant) { return _books.at(grant.second.Book).Until <= now; });
    std::erase_if(_books, [now](const auto &book) { return book.second.Until <= now; });
    _firstEnd = Duration::max();
    for (const auto &[number, book] : _books)
    {
        _firstEnd = std::min(_firstEnd, book.Until);
    }
}

ClaimBallots::Books::iterator ClaimBallots::BookOf(std::string_view from, const ClaimRequest &request,
                                                   Duration now)
{
    std::size_t others = 0;
    for (auto book = _books.begin(); book != _books.end(); ++book)
    {
        const Book &known = book->second;
        if (known.Claimant != from)
        {
            continue;
        }
        const auto age = std::tie(known.Incarnation, known.Session);
        const auto asks = std::tie(request.Incarnation, request.Session);
        if (age == asks)
        {
            return book;
        }
        if (age > asks)
        {
            return _books.end();
        }
        ++others;
    }
    if (others >= MostBooksOfOne)
    {
        return _books.end();
    }
    _firstEnd = std::min(_firstEnd, now + _settings.VotersLease());
    return _books
        .emplace(++_lastBook, Book{.Claimant = std::string(from),
                                   .Incarnation = request.Incarnation,
                                   .Session = request.Session,
                                   .Until = now + _settings.VotersLease()})
        .first;
}

ClaimResult ClaimBallots::Obey(const ClaimOrder &order, Books::value_type &book, Duration now)
{
    const auto grant = _grants.find(order.Name);
    const bool isOwn = grant != _grants.end() && grant->second.Book == book.first;
    switch (order.What)
    {
        case ClaimOrder::Kind::Ask:
            return Ask(order, book, now);
        case ClaimOrder::Kind::Accept:
            if (!isOwn || order.Fence == 0 || !Raise(order.Fence))
            {
                return RefusedFor(order.Name, grant == _grants.end() ? nullptr : &grant->second, now);
            }
            grant->second.Fence = order.Fence;
            return {.What = ClaimResult::Kind::Accepted, .Name = order.Name};
        case ClaimOrder::Kind::Release:
            if (isOwn)
            {
                --book.second.Grants;
                _grants.erase(grant);
            }
            return {.What = ClaimResult::Kind::Released, .Name = order.Name};
    }
    return {.Name = order.Name};
}

ClaimResult ClaimBallots::Ask(const ClaimOrder &order, Books::value_type &book, Duration now)
{
    const auto grant = _grants.find(order.Name);
    if (grant != _grants.end() && grant->second.Book != book.first)
    {
        return RefusedFor(order.Name, &grant->second, now);
    }
    if (grant == _grants.end())
    {
        if (book.second.Grants >= AgreementSettings::MostClaims)
        {
            return {.Name = order.Name};
        }
        ++book.second.Grants;
    }
    // The claimant asks anew, so it holds the claim no longer under the former fence.
    _grants[order.Name] = {.Book = book.first, .Fence = 0};
    return {.What = ClaimResult::Kind::Granted, .Name = order.Name};
}

ClaimResult ClaimBallots::RefusedFor(const std::string &claim, const Grant *grant, Duration now) const
{
    ClaimResult refused{.Name = claim};
    if (grant != nullptr)
    {
        const Book &book = _books.at(grant->Book);
        refused.Holder = book.Claimant;
        refused.Milliseconds =
            grant->Fence == 0
                ? 0
                : static_cast<std::uint32_t>(
                      std::chrono::duration_cast<std::chrono::milliseconds>(book.Until - now).count());
    }
    return refused;
}

bool ClaimBallots::MustStore(const ClaimRequest &request)
{
    bool must = false;
    for (const ClaimOrder &order : request.Orders)
    {
        const auto grant = _grants.find(order.Name);
        if (order.What == ClaimOrder::Kind::Accept && order.Fence > _stored && !IsLeap(order.Fence) &&
            grant != _grants.end() && grant->second.Book == request.Book)
        {
            _storeWanted = std::max(_storeWanted, order.Fence + FencesAhead);
            must = true;
        }
    }
    return must && !_cannotStore;
}

bool ClaimBallots::Raise(std::uint64_t fence)
{
    if (IsLeap(fence) || fence > _stored)
    {
        return false;
    }
    _fences = std::max(_fences, fence);
    return true;
}

std::optional<ClaimBallots::Holding> ClaimBallots::HolderOf(std::string_view claim, Duration now) const
{
    const auto grant = _grants.find(claim);
    if (grant == _grants.end())
    {
        return std::nullopt;
    }
    const Book &book = _books.at(grant->second.Book);
    return book.Until <= now
               ? std::nullopt
               : std::optional(
                     Holding{.Holder = book.Claimant, .Fence = grant->second.Fence, .Until = book.Until});
}

}  // namespace Rabit
