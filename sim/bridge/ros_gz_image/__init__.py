"""The program `image_bridge`, in place of the `ros_gz_image` package."""
