"""The law by which a cost grows with what it depends on, by least squares."""

# Two-sided 95 % quantiles of Student's distribution, by degrees of freedom.
STUDENT_95 = {1: 12.71, 2: 4.30, 3: 3.18, 4: 2.78, 5: 2.57, 6: 2.45, 7: 2.36, 8: 2.31, 9: 2.26, 10: 2.23}
STUDENT_95_BEYOND = 2.2


def solve(matrix, right):
    """The inverse of a small regular matrix and the solution, by Gauss and Jordan."""
    size = len(matrix)
    rows = [list(line) + [float(i == k) for k in range(size)] + [value]
            for i, (line, value) in enumerate(zip(matrix, right))]
    for column in range(size):
        pivot = max(range(column, size), key=lambda i: abs(rows[i][column]))
        rows[column], rows[pivot] = rows[pivot], rows[column]
        rows[column] = [value / rows[column][column] for value in rows[column]]
        for i in range(size):
            if i != column:
                factor = rows[i][column]
                rows[i] = [value - factor * above for value, above in zip(rows[i], rows[column])]
    return [row[size:2 * size] for row in rows], [row[-1] for row in rows]


def fit(points, degree):
    """Coefficients c of y = c[0] + c[1] x + ... that make the sum of the squared relative deviations least, and half
    the width of the 95 % interval of the last one (None: as many coefficients as points)."""
    rows = [([x ** power / y for power in range(degree + 1)], 1.0) for x, y in points]
    normal = [[sum(row[i] * row[k] for row, _ in rows) for k in range(degree + 1)] for i in range(degree + 1)]
    right = [sum(row[i] * value for row, value in rows) for i in range(degree + 1)]
    inverse, coefficients = solve(normal, right)
    freedom = len(rows) - degree - 1
    if freedom <= 0:
        return coefficients, None
    rest = sum((value - sum(c * r for c, r in zip(coefficients, row))) ** 2 for row, value in rows)
    error = (inverse[degree][degree] * rest / freedom) ** 0.5
    return coefficients, error * STUDENT_95.get(freedom, STUDENT_95_BEYOND)


class Law:
    """y = fixed + each * x, for at least three different x; and whether it wants a term in x squared."""

    def __init__(self, points):
        self.points = points
        (self.fixed, self.each), _ = fit(points, 1)
        self.furthest = max(abs(self(x) / y - 1) for x, y in points)
        (_, _, square), interval = fit(points, 2)
        # The square term at the largest x, as a share of the value measured there.
        x, y = max(points)
        self.square_share = square * x * x / y
        self.square_interval = None if interval is None else interval * x * x / y
        # None where there are too few points to tell.
        self.wants_square = None if interval is None else square > interval

    def __call__(self, x):
        return self.fixed + self.each * x
