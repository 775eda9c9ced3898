#pragma once

namespace telltale {

// The distributions of bounds and tests, from Boost.Math. They are compiled once, because each
// takes seconds in a file that compiles its own. A quantile is the value below which the variable
// stays with `probability`, between 0 and 1. A tail is the probability that the variable exceeds x.

double NormalQuantile(double probability);
double NormalCdf(double x);
double NormalTail(double x);

double StudentQuantile(double degrees_of_freedom, double probability);
double StudentTail(double degrees_of_freedom, double x);

double ChiSquaredQuantile(double degrees_of_freedom, double probability);
double ChiSquaredTail(double degrees_of_freedom, double x);

/// Degrees of freedom of the numerator and of the denominator.
double FisherQuantile(double numerator, double denominator, double probability);
double FisherTail(double numerator, double denominator, double x);

/// The probability of success below which, and above which, it would show as few successes among
/// the trials, and as many, with probability `tail`. Source: Clopper, Pearson, Biometrika 26
/// (1934).
double BinomialUpperBound(double trials, double successes, double tail);
double BinomialLowerBound(double trials, double successes, double tail);

}  // namespace telltale
