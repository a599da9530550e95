#pragma once

#include <rabit/RabitEvent.h>
#include <rabit/RabitMessage.h>

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <type_traits>
#include <typeindex>
#include <utility>

namespace Rabit
{

// The result of adding a message to a queue.
enum class QueueAddResult
{
    Ok,
    Full,
    UnknownQueue,
    WrongType  // the queue has another element type, and the message does not convert to it
};

// For logs: `ok`, `full`, `unknown queue`, `wrong type`.
const char *ToString(QueueAddResult result);
std::ostream &operator<<(std::ostream &stream, QueueAddResult result);
// Returns why the queue of that name did not take a message, for RabitQueueReceipt::Refuse.
std::string RefusalReasonOf(QueueAddResult result, const std::string &queue);

// A queue of any kind and element type, as a workspace keeps it. All methods may be called from any thread,
// except that adding to a RabitNonBlockingSPSCQueue is for its producer alone.
class RabitQueueHandle
{
public:
    virtual ~RabitQueueHandle() = default;

    virtual std::type_index ElementType() const = 0;
    // The class of the queue, for instance RabitMessageQueue<int>, and the queue as one.
    virtual std::type_index QueueType() const = 0;
    virtual std::shared_ptr<void> Queue() const = 0;
    virtual int Capacity() const = 0;
    // FillLevel: the number of messages that wait. RefusedAdds: those refused because the queue was full,
    // since it was made.
    virtual int FillLevel() const = 0;
    virtual std::uint64_t RefusedAdds() const = 0;

    // Adds *element, which has the given type. Moves from it unless the result is WrongType.
    virtual QueueAddResult AddElement(std::type_index type, void *element) = 0;
    // Adds a message to a queue of shared pointers to RabitMessage or to a class that this one is derived
    // from.
    virtual QueueAddResult AddMessage(const std::shared_ptr<RabitMessage> &message) = 0;
    virtual QueueAddResult AddString(std::string text) = 0;
    // Adds a shared pointer to a queue of shared pointers to a base of its class. throwPointer throws the
    // object's address as a pointer to its static type. A catch clause for pointers to the queue's class
    // catches it exactly if C++ converts the one pointer to the other.
    virtual QueueAddResult AddPointer(const std::shared_ptr<void> &owner, void (*throwPointer)(void *),
                                      void *object) = 0;

    virtual bool HasEnqueuedHandlers() const = 0;
    virtual RabitConnection ConnectEnqueued(RabitHandler handler) = 0;
    virtual RabitConnection ConnectDequeued(RabitHandler handler) = 0;
    virtual RabitConnection ConnectRefused(RabitHandler handler) = 0;
};

namespace Detail
{

template <typename T>
struct IsSharedPointer : std::false_type
{
};
template <typename T>
struct IsSharedPointer<std::shared_ptr<T>> : std::true_type
{
};

template <typename QueueT>
class TypedQueueHandle final : public RabitQueueHandle
{
    using Element = typename QueueT::ElementType;

public:
    explicit TypedQueueHandle(std::shared_ptr<QueueT> queue) : _queue(std::move(queue)) {}

    std::type_index ElementType() const override { return typeid(Element); }
    std::type_index QueueType() const override { return typeid(QueueT); }
    std::shared_ptr<void> Queue() const override { return _queue; }
    int Capacity() const override { return _queue->GetMaxNoMessagesAllowedInQueue(); }
    int FillLevel() const override { return _queue->NoMessagesInQueue(); }
    std::uint64_t RefusedAdds() const override { return _queue->GetNumberOfRefusedMessages(); }

    QueueAddResult AddElement(std::type_index type, void *element) override
    {
        if (type != typeid(Element))
        {
            return QueueAddResult::WrongType;
        }
        return Add(std::move(*static_cast<Element *>(element)));
    }

    QueueAddResult AddMessage(const std::shared_ptr<RabitMessage> &message) override
    {
        if constexpr (IsSharedPointer<Element>::value)
        {
            using Pointee = typename Element::element_type;
            if constexpr (std::is_same_v<Pointee, RabitMessage>)
            {
                return Add(message);
            }
            else if constexpr (std::is_base_of_v<RabitMessage, Pointee>)
            {
                Element converted = std::dynamic_pointer_cast<Pointee>(message);
                return converted ? Add(std::move(converted)) : QueueAddResult::WrongType;
            }
        }
        return QueueAddResult::WrongType;
    }

    QueueAddResult AddString(std::string text) override
    {
        if constexpr (std::is_same_v<Element, std::string>)
        {
            return Add(std::move(text));
        }
        else
        {
            static_cast<void>(text);
            return QueueAddResult::WrongType;
        }
    }

    QueueAddResult AddPointer(const std::shared_ptr<void> &owner, void (*throwPointer)(void *),
                              void *object) override
    {
        if constexpr (IsSharedPointer<Element>::value)
        {
            typename Element::element_type *converted = nullptr;
            try
            {
                throwPointer(object);
            }
            catch (typename Element::element_type *caught)
            {
                converted = caught;
            }
            catch (...)
            {
                return QueueAddResult::WrongType;
            }
            return Add(Element(owner, converted));
        }
        else
        {
            static_cast<void>(owner);
            static_cast<void>(throwPointer);
            static_cast<void>(object);
            return QueueAddResult::WrongType;
        }
    }

    bool HasEnqueuedHandlers() const override { return _queue->HasEnqueuedHandlers(); }
    RabitConnection ConnectEnqueued(RabitHandler handler) override
    {
        return _queue->ConnectSomethingEnqueued(std::move(handler));
    }
    RabitConnection ConnectDequeued(RabitHandler handler) override
    {
        return _queue->ConnectSomethingDequeued(std::move(handler));
    }
    RabitConnection ConnectRefused(RabitHandler handler) override
    {
        return _queue->ConnectSomethingRefused(std::move(handler));
    }

private:
    QueueAddResult Add(Element element)
    {
        return _queue->AddMessage(std::move(element)) ? QueueAddResult::Ok : QueueAddResult::Full;
    }

    const std::shared_ptr<QueueT> _queue;
};

}  // namespace Detail
}  // namespace Rabit
