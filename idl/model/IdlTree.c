#include "model/IdlTree.h"

#include <idl/processor.h>
#include <idl/tree.h>
#include <idlc/generator.h>

static const idl_node_t *Node(TreeNode node)
{
    return node;
}

static enum TreeKind KindOfScalar(idl_type_t type)
{
    switch (type)
    {
        case IDL_BOOL:
            return TreeBool;
        case IDL_CHAR:
            return TreeChar;
        case IDL_OCTET:
            return TreeOctet;
        case IDL_INT8:
            return TreeInt8;
        case IDL_UINT8:
            return TreeUint8;
        case IDL_SHORT:
        case IDL_INT16:
            return TreeInt16;
        case IDL_USHORT:
        case IDL_UINT16:
            return TreeUint16;
        case IDL_LONG:
        case IDL_INT32:
            return TreeInt32;
        case IDL_ULONG:
        case IDL_UINT32:
            return TreeUint32;
        case IDL_LLONG:
        case IDL_INT64:
            return TreeInt64;
        case IDL_ULLONG:
        case IDL_UINT64:
            return TreeUint64;
        case IDL_FLOAT:
            return TreeFloat;
        case IDL_DOUBLE:
            return TreeDouble;
        case IDL_LDOUBLE:
            return TreeLongDouble;
        case IDL_WCHAR:
            return TreeWideChar;
        case IDL_ANY:
            return TreeAny;
        case IDL_STRING:
            return TreeString;
        case IDL_WSTRING:
            return TreeWideString;
        case IDL_FIXED_PT:
            return TreeFixed;
        default:
            return TreeUnknown;
    }
}

enum TreeKind TreeKindOf(TreeNode node)
{
    // A forward declaration also carries the mask of what it declares, so it must be asked for first.
    if (idl_mask(node) & IDL_FORWARD)
    {
        return TreeForward;
    }
    if (idl_is_module(node))
    {
        return TreeModule;
    }
    if (idl_is_const(node))
    {
        return TreeConst;
    }
    if (idl_is_alias(node))
    {
        return TreeAlias;
    }
    if (idl_is_typedef(node))
    {
        return TreeTypedef;
    }
    if (idl_is_struct(node))
    {
        return TreeStruct;
    }
    if (idl_is_union(node))
    {
        return TreeUnion;
    }
    if (idl_is_enum(node) || idl_is_enumerator(node))
    {
        return TreeEnum;
    }
    if (idl_is_bitmask(node))
    {
        return TreeBitmask;
    }
    if (idl_mask(node) & IDL_ANNOTATION)
    {
        return TreeAnnotation;
    }
    if (idl_is_sequence(node))
    {
        return TreeSequence;
    }
    return KindOfScalar(idl_type(node));
}

TreeNode TreeNext(TreeNode node)
{
    return Node(node)->next;
}

const char *TreeName(TreeNode node)
{
    return idl_identifier(node);
}

const char *TreeConstruct(TreeNode node)
{
    return idl_construct(node);
}

const char *TreeFileOf(TreeNode node)
{
    const idl_file_t *file = Node(node)->symbol.location.first.file;
    return file ? file->name : "";
}

uint32_t TreeLineOf(TreeNode node)
{
    return Node(node)->symbol.location.first.line;
}

bool TreeInMainFile(const void *state, TreeNode node)
{
    return Node(node)->symbol.location.first.source == ((const idl_pstate_t *)state)->sources;
}

TreeNode TreeRoot(const void *state)
{
    return ((const idl_pstate_t *)state)->root;
}

TreeNode TreeModuleContents(TreeNode module)
{
    return ((const idl_module_t *)module)->definitions;
}

TreeNode TreeAnnotations(TreeNode node)
{
    return Node(node)->annotations;
}

const char *TreeAnnotationName(TreeNode annotation)
{
    return ((const idl_annotation_appl_t *)annotation)->annotation->name->identifier;
}

TreeNode TreeBase(TreeNode structure)
{
    const idl_inherit_spec_t *inherit = ((const idl_struct_t *)structure)->inherit_spec;
    return inherit ? inherit->base : NULL;
}

TreeNode TreeMembers(TreeNode structure)
{
    return ((const idl_struct_t *)structure)->members;
}

bool TreeIsNested(TreeNode structure)
{
    return ((const idl_struct_t *)structure)->nested.value;
}

bool TreeHasKeylist(TreeNode structure)
{
    return ((const idl_struct_t *)structure)->keylist != NULL;
}

static enum TreeExtensibility Extensibility(idl_extensibility_t value)
{
    switch (value)
    {
        case IDL_APPENDABLE:
            return TreeAppendable;
        case IDL_MUTABLE:
            return TreeMutable;
        default:
            return TreeFinal;
    }
}

enum TreeExtensibility TreeExtensibilityOf(TreeNode node)
{
    return Extensibility(idl_is_struct(node) ? ((const idl_struct_t *)node)->extensibility.value
                                             : ((const idl_union_t *)node)->extensibility.value);
}

bool TreeAllowsXcdr1(TreeNode node)
{
    // Without the annotation the parser rules XCDR1 out for what is not final, which is its own limit: in
    // XCDR1 an appendable type is encoded as a final one.
    const bool annotated = idl_is_struct(node)
                               ? ((const idl_struct_t *)node)->data_representation.annotation != NULL
                               : ((const idl_union_t *)node)->data_representation.annotation != NULL;
    return !annotated || (idl_allowable_data_representations(node) & IDL_DATAREPRESENTATION_FLAG_XCDR1) != 0;
}

TreeNode TreeDeclarators(TreeNode memberOrTypedef)
{
    return idl_is_typedef(memberOrTypedef) ? ((const idl_typedef_t *)memberOrTypedef)->declarators
                                           : ((const idl_member_t *)memberOrTypedef)->declarators;
}

TreeNode TreeTypeSpec(TreeNode node)
{
    return idl_type_spec(node);
}

bool TreeIsKey(TreeNode member)
{
    return ((const idl_member_t *)member)->key.value;
}

const char *TreeUnit(TreeNode member)
{
    return ((const idl_member_t *)member)->unit.value;
}

uint32_t TreeMemberId(TreeNode declarator)
{
    return ((const idl_declarator_t *)declarator)->id.value;
}

TreeNode TreeDefault(TreeNode member)
{
    return ((const idl_member_t *)member)->value.value;
}

TreeNode TreeDimensions(TreeNode declarator)
{
    return ((const idl_declarator_t *)declarator)->const_expr;
}

uint32_t TreeDimension(TreeNode literal)
{
    return ((const idl_literal_t *)literal)->value.uint32;
}

uint32_t TreeBound(TreeNode type)
{
    return idl_is_sequence(type) ? ((const idl_sequence_t *)type)->maximum
                                 : ((const idl_string_t *)type)->maximum;
}

TreeNode TreeSwitch(TreeNode unionNode)
{
    return ((const idl_union_t *)unionNode)->switch_type_spec;
}

TreeNode TreeSwitchType(TreeNode switchSpec)
{
    return ((const idl_switch_type_spec_t *)switchSpec)->type_spec;
}

bool TreeSwitchIsKey(TreeNode switchSpec)
{
    return ((const idl_switch_type_spec_t *)switchSpec)->key.value;
}

TreeNode TreeCases(TreeNode unionNode)
{
    return ((const idl_union_t *)unionNode)->cases;
}

TreeNode TreeCaseDeclarator(TreeNode caseNode)
{
    return ((const idl_case_t *)caseNode)->declarator;
}

TreeNode TreeLabels(TreeNode caseNode)
{
    return ((const idl_case_t *)caseNode)->labels;
}

bool TreeIsDefaultLabel(TreeNode label)
{
    return (idl_mask(label) & IDL_DEFAULT_CASE_LABEL) == IDL_DEFAULT_CASE_LABEL;
}

int64_t TreeLabelValue(TreeNode label)
{
    return idl_case_label_intvalue(label);
}

bool TreeHasDefaultValue(TreeNode unionNode)
{
    const idl_case_label_t *label = ((const idl_union_t *)unionNode)->default_case;
    return label && label->const_expr;
}

int64_t TreeDefaultValue(TreeNode unionNode)
{
    return idl_case_label_intvalue(((const idl_union_t *)unionNode)->default_case);
}

uint64_t TreeUnusedLabels(TreeNode unionNode)
{
    return ((const idl_union_t *)unionNode)->unused_labels;
}

TreeNode TreeEnumerators(TreeNode enumeration)
{
    return ((const idl_enum_t *)enumeration)->enumerators;
}

uint32_t TreeEnumeratorValue(TreeNode enumerator)
{
    return ((const idl_enumerator_t *)enumerator)->value.value;
}

TreeNode TreeDefaultEnumerator(TreeNode enumeration)
{
    return ((const idl_enum_t *)enumeration)->default_enumerator;
}

uint16_t TreeEnumBitBound(TreeNode enumeration)
{
    return ((const idl_enum_t *)enumeration)->bit_bound.value;
}

TreeNode TreeBits(TreeNode bitmask)
{
    return ((const idl_bitmask_t *)bitmask)->bit_values;
}

uint16_t TreeBitPosition(TreeNode bit)
{
    return ((const idl_bit_value_t *)bit)->position.value;
}

uint16_t TreeBitmaskBitBound(TreeNode bitmask)
{
    return ((const idl_bitmask_t *)bitmask)->bit_bound.value;
}

TreeNode TreeConstType(TreeNode constant)
{
    return ((const idl_const_t *)constant)->type_spec;
}

TreeNode TreeConstValue(TreeNode constant)
{
    return ((const idl_const_t *)constant)->const_expr;
}

enum TreeKind TreeLiteralKind(TreeNode literal)
{
    return KindOfScalar(idl_type(literal));
}

bool TreeIsEnumerator(TreeNode node)
{
    return idl_is_enumerator(node);
}

int64_t TreeLiteralSigned(TreeNode literal)
{
    const idl_literal_t *value = literal;
    switch (TreeLiteralKind(literal))
    {
        case TreeChar:
            return value->value.chr;
        case TreeInt8:
            return value->value.int8;
        case TreeInt16:
            return value->value.int16;
        case TreeInt32:
            return value->value.int32;
        default:
            return value->value.int64;
    }
}

uint64_t TreeLiteralUnsigned(TreeNode literal)
{
    const idl_literal_t *value = literal;
    switch (TreeLiteralKind(literal))
    {
        case TreeBool:
            return value->value.bln;
        case TreeOctet:
        case TreeUint8:
            return value->value.uint8;
        case TreeUint16:
            return value->value.uint16;
        case TreeUint32:
            return value->value.uint32;
        default:
            return value->value.uint64;
    }
}

double TreeLiteralDouble(TreeNode literal)
{
    const idl_literal_t *value = literal;
    return TreeLiteralKind(literal) == TreeFloat ? (double)value->value.flt : value->value.dbl;
}

const char *TreeLiteralString(TreeNode literal)
{
    return ((const idl_literal_t *)literal)->value.str;
}

TreeNode TreeFirstSource(const void *state)
{
    return ((const idl_pstate_t *)state)->sources;
}

TreeNode TreeNextSource(TreeNode source)
{
    return ((const idl_source_t *)source)->next;
}

TreeNode TreeIncludes(TreeNode source)
{
    return ((const idl_source_t *)source)->includes;
}

const char *TreeSourcePath(TreeNode source)
{
    const idl_file_t *path = ((const idl_source_t *)source)->path;
    return path ? path->name : "";
}

const char *TreeOutputDirectory(const void *config)
{
    return ((const idlc_generator_config_t *)config)->output_dir;
}

const char *TreeBaseDirectory(const void *config)
{
    return ((const idlc_generator_config_t *)config)->base_dir;
}
