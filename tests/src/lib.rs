//! The test harness: one compiled binary family that shares an adapter.
