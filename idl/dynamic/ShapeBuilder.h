// Makes the shapes of one message from the model of an IDL text.
#pragma once

#include <rabit/dynamic/Shape.h>
#include "model/Model.h"

#include <map>
#include <memory>
#include <stdexcept>
#include <string>

namespace Rabit::Dynamic
{

// Why a text is refused, in one line.
struct Refused : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

class ShapeBuilder
{
public:
    // The model is only read while building.
    explicit ShapeBuilder(const RabitIdl::Model &model) : _model(model) {}
    // The message of that name with its modules. Throws Refused if there is none or a limit is exceeded.
    std::unique_ptr<const Shapes> Build(const std::string &name);

private:
    const Shape *Of(const RabitIdl::Type &type);
    Shape OfDefinition(const RabitIdl::Definition &definition);
    Shape OfStruct(const RabitIdl::StructDefinition &definition);
    Shape OfUnion(const RabitIdl::UnionDefinition &definition);
    const Shape *Keep(Shape shape);

    const RabitIdl::Model &_model;
    std::unique_ptr<Shapes> _shapes = std::make_unique<Shapes>();
    std::map<const RabitIdl::Definition *, const Shape *> _known;
};

}  // namespace Rabit::Dynamic
