#include "telltale/core/uncertainty/distributions.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace telltale {
namespace {

using Normal = boost::math::normal_distribution<double>;
using Student = boost::math::students_t_distribution<double>;
using ChiSquared = boost::math::chi_squared_distribution<double>;
using Fisher = boost::math::fisher_f_distribution<double>;
using Binomial = boost::math::binomial_distribution<double>;

template <class Distribution>
double Tail(const Distribution& distribution, double x) {
  return boost::math::cdf(boost::math::complement(distribution, x));
}

}  // namespace

double NormalQuantile(double probability) {
  return boost::math::quantile(Normal(), probability);
}

double NormalCdf(double x) {
  return boost::math::cdf(Normal(), x);
}

double NormalTail(double x) {
  return Tail(Normal(), x);
}

double StudentQuantile(double degrees_of_freedom, double probability) {
  return boost::math::quantile(Student(degrees_of_freedom), probability);
}

double StudentTail(double degrees_of_freedom, double x) {
  return Tail(Student(degrees_of_freedom), x);
}

double ChiSquaredQuantile(double degrees_of_freedom, double probability) {
  return boost::math::quantile(ChiSquared(degrees_of_freedom), probability);
}

double ChiSquaredTail(double degrees_of_freedom, double x) {
  return Tail(ChiSquared(degrees_of_freedom), x);
}

double FisherQuantile(double numerator, double denominator, double probability) {
  return boost::math::quantile(Fisher(numerator, denominator), probability);
}

double FisherTail(double numerator, double denominator, double x) {
  return Tail(Fisher(numerator, denominator), x);
}

double BinomialUpperBound(double trials, double successes, double tail) {
  return Binomial::find_upper_bound_on_p(trials, successes, tail);
}

double BinomialLowerBound(double trials, double successes, double tail) {
  return Binomial::find_lower_bound_on_p(trials, successes, tail);
}

}  // namespace telltale
