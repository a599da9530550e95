#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "backfill.idl.h"
#include "backfill/PostStore.h"

namespace Rabit::Backfill
{

// Answers questions about posts. Keeps nothing from one question to the next, but for the bytes of the last
// large post, so a restart changes nothing.
class PostAnswers
{
public:
    // Bytes of posts in an answer. A larger post is answered in parts. A restart of either end costs at most
    // the answers under way.
    static constexpr std::size_t LargestAnswer = 16U << 10;
    // The least that a question can ask for.
    static constexpr std::size_t SmallestAnswer = 512;

    // Answer::size of an answer that FAILED: the posts of its range can never be read, since a file is
    // damaged or was removed.
    static constexpr std::uint64_t NeverReadable = 1;

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
    void AnswerPart(const Question &question, std::size_t most, Answer &answer);

    // The large post that is answered in parts.
    struct Large
    {
        std::string Name;
        std::uint64_t Incarnation = 0;
        Stamp Of = 0;
        std::vector<std::uint8_t> Bytes;
    };

    PostStore &_store;
    const MayHave _mayHave;
    const Offers _offers;
    Large _large;
};

}  // namespace Rabit::Backfill
