"""What machines can: reach, sensitivity, and which one can run a job."""
