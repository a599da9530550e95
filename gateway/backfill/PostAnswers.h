#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "backfill.idl.h"
#include "backfill/PostStore.h"

namespace Rabit::Backfill
{

// Answers questions about posts. Keeps nothing from one question to the next, so a restart changes nothing.
class PostAnswers
{
public:
    // Bytes of posts in an answer, unless a single post is larger. A restart of either end costs at most the
    // answers under way.
    static constexpr std::size_t LargestAnswer = 16U << 10;

    // True if that node may have that message.
    using MayHave = std::function<bool(const std::string &node, const std::string &message)>;
    // True if this node publishes and records that message.
    using Offers = std::function<bool(const std::string &message)>;

    // The store must outlive the object.
    PostAnswers(PostStore &store, MayHave mayHave, Offers offers)
        : _store(store), _mayHave(std::move(mayHave)), _offers(std::move(offers))
    {
    }

    // The question must be of the kind SPANS or POSTS.
    Answer Of(const std::string &node, const Question &question);

private:
    void AnswerPosts(const Question &question, Answer &answer);

    PostStore &_store;
    const MayHave _mayHave;
    const Offers _offers;
};

}  // namespace Rabit::Backfill
