#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

// Eigen's decompositions of matrices of any size, compiled once, in eigen_decompositions.cpp: each
// costs seconds in every file that compiles its own. Include this header instead of Eigen's and
// pass matrices and vectors: an expression is a type of its own and is compiled again.
namespace Eigen {

extern template JacobiSVD<MatrixXd>& JacobiSVD<MatrixXd>::compute(const MatrixXd&, unsigned);
extern template void SVDBase<JacobiSVD<MatrixXd>>::_solve_impl(const VectorXd&, VectorXd&) const;

extern template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);

extern template void CompleteOrthogonalDecomposition<MatrixXd>::computeInPlace();
extern template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl(const VectorXd&,
                                                                            VectorXd&) const;
extern template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl(
    const MatrixXd::IdentityReturnType&, MatrixXd&) const;

extern template void PartialPivLU<MatrixXd>::compute();

extern template void ColPivHouseholderQR<MatrixXd>::computeInPlace();
extern template void ColPivHouseholderQR<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;

extern template void HouseholderQR<MatrixXd>::computeInPlace();
extern template void HouseholderQR<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;

extern template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
extern template void LDLT<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
extern template void LDLT<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;

extern template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
extern template void LLT<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
extern template void LLT<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;

}  // namespace Eigen
