// smaller.mjs: a picture with fewer pixels.

// The mean of all pixels below each new one; what is of another form is cut.
export function smaller(picture, width, height) {
    const { data } = picture, size = Math.min(picture.width / width, picture.height / height);
    const left = (picture.width - size * width) / 2, top = (picture.height - size * height) / 2;
    const made = Buffer.alloc(4 * width * height, 255);
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++)
            for (let k = 0; k < 3; k++) {
                let sum = 0, count = 0;
                for (let j = Math.floor(top + y * size); j < top + (y + 1) * size && j < picture.height; j++)
                    for (let i = Math.floor(left + x * size); i < left + (x + 1) * size && i < picture.width; i++, count++)
                        sum += data[4 * (j * picture.width + i) + k];
                made[4 * (y * width + x) + k] = sum / count;
            }
    return { width, height, data: made };
}
